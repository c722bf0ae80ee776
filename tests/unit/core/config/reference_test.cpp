#include "core/config/reference.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/config/config.h"
#include "tests/unit/core/config/example_options.h"

namespace saccade::config {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A method whose own section has a switch, and a key that takes two forms.
struct Nested {
  std::string method = "mean";
  bool weighted = false;
  double sigma_px = 1;
  double scale = 1;
  double window_s = 0.1;
  double rank = 0.5;
  std::vector<double> scales{1, 1};
};

void describe(Fields& fields, Nested& nested) {
  fields.choice("method", nested.method,
                {{"mean", "mean"}, {"median", "median"}, {"kernel", "kernel"}}, "The method.");
  if (nested.method == "kernel") {
    fields.group(
        "kernel",
        [&](Fields& kernel) {
          kernel.value("weighted", nested.weighted, "Whether samples are weighted.");
          if (nested.weighted) kernel.value("sigma_px", nested.sigma_px, "Of the weight.").above(0);
        },
        "A kernel.");
  }
  if (nested.method != "mean") fields.value("window_s", nested.window_s, "The window.");
  if (nested.method == "median" || (nested.method == "kernel" && nested.weighted))
    fields.value("rank", nested.rank, "The rank.").range(0, 1);
  if (fields.form("scale") == Form::kList) {
    fields.value("scale", nested.scales, "The scale.").above(0);
  } else {
    fields.value("scale", nested.scale, "The scale.").above(0);
  }
}

std::vector<std::string> names_of(const std::vector<ReferenceKey>& keys) {
  std::vector<std::string> names;
  for (const ReferenceKey& key : keys) names.push_back(key.name);
  return names;
}

const ReferenceKey& key_of(const std::vector<ReferenceKey>& keys, const std::string& name) {
  return *std::find_if(keys.begin(), keys.end(), [&](const auto& key) { return key.name == name; });
}

TEST(Reference, ListsTheKeysOfChoicesThatAreNotTaken) {
  const auto keys = reference<Nested>();
  EXPECT_THAT(names_of(keys), ElementsAre("method", "kernel", "kernel.weighted", "kernel.sigma_px",
                                          "window_s", "rank", "scale"));
  EXPECT_THAT(key_of(keys, "kernel").conditions, ElementsAre("`method: kernel`"));
  EXPECT_THAT(key_of(keys, "kernel.sigma_px").conditions,
              ElementsAre("`method: kernel`", "`kernel.weighted: true`"));
  EXPECT_THAT(key_of(keys, "window_s").conditions, ElementsAre("`method: median` or `kernel`"));
  EXPECT_THAT(key_of(keys, "rank").conditions,
              ElementsAre("`method: median` or `kernel.weighted: true`"));
  EXPECT_THAT(key_of(keys, "scale").conditions, IsEmpty());
}

TEST(Reference, StatesTypeDefaultRuleAndHelp) {
  const auto keys = reference<testing::Options>();
  const ReferenceKey& samples = key_of(keys, "samples");
  EXPECT_EQ(samples.type, "whole number");
  EXPECT_EQ(samples.initial, "500");
  EXPECT_EQ(samples.rule, "6 to 1000000");
  EXPECT_EQ(samples.help, "points per iteration");
  EXPECT_EQ(key_of(keys, "ratio").rule, "> 0, <= 1");
  EXPECT_EQ(key_of(keys, "distortion").type, "list of 5 numbers");
  EXPECT_EQ(key_of(keys, "control_poses").type, "list of lists of numbers");
  EXPECT_EQ(key_of(keys, "control_poses").rule, "7 to 8 numbers each");
  EXPECT_EQ(key_of(keys, "duration_s").type, "number or ~");
  EXPECT_EQ(key_of(keys, "grid").type, "map of lists of texts");
  EXPECT_EQ(key_of(keys, "source").rule, "file, circle");
  EXPECT_EQ(key_of(keys, "meshes[].file").rule, "required");
  EXPECT_EQ(key_of(keys, "extra_blur.sigma_px").rule, "> 0");
  EXPECT_THAT(key_of(keys, "radius_m").conditions, ElementsAre("`source: circle`"));
  EXPECT_THAT(key_of(keys, "file").conditions, ElementsAre("`source: file`"));
  EXPECT_EQ(key_of(reference<Nested>(), "scale").type, "number or list of numbers");
}

/// A method and a preset that set defaults, and a number that is special where it is 0.
struct Preset {
  std::string method = "mean";
  std::string preset = "good";
  double sigma_px = 1;
  double period_s = 2;
  double phase = 0;
};

void describe(Fields& fields, Preset& options) {
  fields.choice("method", options.method, {{"mean", "mean"}, {"median", "median"}}, "The method.");
  double sigma_px = options.method == "median" ? 3 : options.sigma_px;
  fields.choice("preset", options.preset, {{"good", "good"}, {"fast", "fast"}}, "The preset.");
  if (fields.has("preset") && options.preset == "fast") sigma_px = 5;
  fields.value("sigma_px", sigma_px, "Of the weight.").above(0);
  fields.value("period_s", options.period_s, "The period; 0 is none.").at_least(0);
  if (!fields.is_zero("period_s", options.period_s))
    fields.value("phase", options.phase, "The phase.");
}

TEST(Reference, StatesTheDefaultsThatAChoiceChanges) {
  const auto keys = reference<Preset>();
  EXPECT_EQ(key_of(keys, "sigma_px").initial, "1");
  EXPECT_THAT(key_of(keys, "sigma_px").other_initials,
              ElementsAre("`3` with `method: median`", "`5` with `preset: fast`"));
  EXPECT_THAT(key_of(keys, "preset").other_initials, IsEmpty());
  EXPECT_THAT(key_of(keys, "phase").conditions, ElementsAre("`period_s: above 0`"));
  EXPECT_THAT(to_markdown(keys),
              HasSubstr("| `sigma_px` | number | `1`; `3` with `method: median`; "
                        "`5` with `preset: fast` | > 0 |"));
}

TEST(Reference, AsMarkdownHasATableForEachSection) {
  const std::string text = to_markdown(reference<Nested>());
  EXPECT_THAT(text, HasSubstr("| `window_s` | number | `0.1` |  | The window. Only with "
                              "`method: median` or `kernel`. |\n"));
  EXPECT_THAT(text, HasSubstr("\n## `kernel`\n\nA kernel. Only with `method: kernel`.\n"));
  EXPECT_THAT(text, HasSubstr("| `sigma_px` | number | `1` | > 0 | Of the weight. Only with "
                              "`kernel.weighted: true`. |\n"));
}

}  // namespace
}  // namespace saccade::config
