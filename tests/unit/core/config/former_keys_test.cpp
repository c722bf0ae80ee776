#include "core/config/former_keys.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/config/config.h"
#include "tests/support/error_of.h"
#include "tests/unit/core/config/example_options.h"

namespace saccade::config {
namespace {

using saccade::testing::error_of;

const std::vector<FormerKey> kRows{
    {"blur.width_px", "blur.sigma_px", ""},
    {"file.legacy", "", "meshes are read as they are"},
    {"levels", "no_event", ""},
    {"levels.still_px", "no_event.spacing_px", ""},
    {"source=ring", "source=circle", ""},
    {"still_px", "", "it is always 0.3 px"},
};

std::string answer(const std::string& path) {
  return explain_former_key(path, kRows).value_or("none");
}

std::string former_error(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return error_of(
      [&] { return read(parse(text, "a.yaml", "/data", overrides), testing::Options{}, kRows); });
}

TEST(FormerKeys, TheLongestEndOfThePathDecides) {
  EXPECT_EQ(answer("levels.still_px"), "'levels.still_px' is now 'no_event.spacing_px'");
  EXPECT_EQ(answer("intensity.levels.still_px"), "'levels.still_px' is now 'no_event.spacing_px'");
  EXPECT_EQ(answer("still_px"), "'still_px' is no longer a key: it is always 0.3 px");
  EXPECT_EQ(answer("other.still_px"), "none");
  EXPECT_EQ(answer("scene.file[3].legacy"),
            "'file.legacy' is no longer a key: meshes are read as they are");
  EXPECT_EQ(answer("instill_px"), "none");
  EXPECT_EQ(answer("px"), "none");
}

TEST(FormerKeys, AnUnknownKeyIsAnsweredWithItsNewNameAndTheLine) {
  EXPECT_EQ(former_error("verbose: true\nblur:\n  width_px: 1\n"),
            "a.yaml:3: 'blur.width_px' is now 'blur.sigma_px'");
  EXPECT_EQ(former_error("still_px: 1\n"),
            "a.yaml:1: 'still_px' is no longer a key: it is always 0.3 px");
  EXPECT_EQ(former_error("", {"blur.width_px=1"}),
            "--set blur.width_px: 'blur.width_px' is now 'blur.sigma_px'");
}

TEST(FormerKeys, AKeyInsideAFormerSectionComesBeforeTheSection) {
  EXPECT_EQ(former_error("levels:\n  weight: 2\n  still_px: 1\n"),
            "a.yaml:3: 'levels.still_px' is now 'no_event.spacing_px'");
  EXPECT_EQ(former_error("", {"levels.still_px=1"}),
            "--set levels.still_px: 'levels.still_px' is now 'no_event.spacing_px'");
  EXPECT_EQ(former_error("levels:\n  weight: 2\n"), "a.yaml:1: 'levels' is now 'no_event'");
}

TEST(FormerKeys, AFormerValueOfAChoice) {
  EXPECT_EQ(former_error("source: ring\n"),
            "a.yaml:1: source: 'source=ring' is now 'source=circle'");
}

TEST(FormerKeys, AKeyOfAnotherChoiceIsNoFormerOne) {
  const std::vector<FormerKey> rows{{"radius_m", "size_m", ""}};
  EXPECT_EQ(
      error_of([&] { return read(parse("radius_m: 1\n", "a.yaml"), testing::Options{}, rows); }),
      "a.yaml:1: key 'radius_m' does not apply to source: file (it belongs to source: "
      "circle)");
}

TEST(FormerKeys, TheTableIsSortedWithoutDoublesAndSaysWhatToDo) {
  const auto rows = former_keys();
  const auto in_order = [](const FormerKey& a, const FormerKey& b) {
    return a.old_key < b.old_key;
  };
  EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end(), in_order));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_NE(rows[i].new_key.empty(), rows[i].note.empty()) << rows[i].old_key;
    EXPECT_TRUE(i == 0 || rows[i].old_key != rows[i - 1].old_key) << rows[i].old_key;
  }
}

}  // namespace
}  // namespace saccade::config
