#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/config/config.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"
#include "tests/unit/core/config/example_options.h"

namespace saccade::config {
namespace {

using saccade::testing::error_of;
using saccade::testing::TemporaryFolder;
using testing::Options;

Options read_text(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return read<Options>(parse(text, "a.yaml", "/data", overrides));
}

std::string read_error(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return error_of([&] { return read_text(text, overrides); });
}

TEST(Read, TakesStatedValuesAndKeepsOtherDefaults) {
  const Options options = read_text(
      "verbose: true\nsamples: 1e3\nseed: 18446744073709551615\nratio: .5\nname: 12\n"
      "distortion: [1, -2, 3e-1, 0, +5]\nblur: {sigma_px: 3}\nlimits: {far_m: 9}\n"
      "control_poses: [[0, 1, 2, 3, 0, 0, 0, 1], [1, 2, 3, 0, 0, 0, 1]]\n"
      "grid: {a.b: [1, x y]}\nmeshes: [{file: m.obj}, {file: /abs.obj, translation: [1, 2, 3]}]\n");
  EXPECT_TRUE(options.verbose);
  EXPECT_EQ(options.samples, 1000);
  EXPECT_EQ(options.seed, 18446744073709551615U);
  EXPECT_EQ(options.ratio, 0.5);
  EXPECT_EQ(options.name, "12");
  EXPECT_EQ(options.distortion, (std::array<double, 5>{1, -2, 0.3, 0, 5}));
  EXPECT_EQ(options.blur.sigma_px, 3);
  EXPECT_TRUE(options.blur.separable);
  EXPECT_EQ(options.near_m, 1);
  EXPECT_EQ(options.far_m, 9);
  EXPECT_EQ(options.control_poses[1].size(), 7U);
  EXPECT_EQ(options.grid.at("a.b"), (std::vector<std::string>{"1", "x y"}));
  EXPECT_EQ(options.meshes[0].file, "/data/m.obj");
  EXPECT_EQ(options.meshes[1].file, "/abs.obj");
  EXPECT_EQ(options.meshes[1].translation, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(options.gain, 0.1F);
  EXPECT_EQ(options.duration_s, std::nullopt);
}

TEST(Read, OptionalSectionsAreThereOrNot) {
  EXPECT_FALSE(read_text("").extra_blur);
  EXPECT_FALSE(read_text("extra_blur: ~").extra_blur);
  EXPECT_EQ(read_text("extra_blur: {}").extra_blur->sigma_px, 1);
  EXPECT_EQ(read_text("extra_blur: {sigma_px: 4}").extra_blur->sigma_px, 4);
  Options defaults;
  defaults.extra_blur.emplace();
  EXPECT_TRUE(read(Document::empty(), defaults).extra_blur);
  EXPECT_FALSE(read(parse("extra_blur: ~", "a.yaml"), defaults).extra_blur);
}

TEST(Read, PathsAreRelativeToTheFileThatStatesThem) {
  const TemporaryFolder folder;
  folder.write("base/base.yaml", "output: out\nmeshes: [{file: ../m.obj}]\n");
  const auto file = folder.write("main.yaml", "include: base/base.yaml\n");
  const Options options = read<Options>(load(file));
  EXPECT_EQ(options.output, folder.path() / "base/out");
  EXPECT_EQ(options.meshes[0].file, folder.path() / "m.obj");
  EXPECT_EQ(read_text("", {"output=there"}).output, "there");
}

TEST(Read, UnknownKeys) {
  EXPECT_EQ(read_error("verbose: true\nsampels: 3\n"),
            "a.yaml:2: unknown key 'sampels'; did you mean 'samples'?");
  EXPECT_EQ(read_error("blur:\n  sigma: 1\n"),
            "a.yaml:2: unknown key 'sigma' in 'blur'; did you mean 'sigma_px'?");
  EXPECT_EQ(read_error("verbose: true\nseed:1\n"),
            "a.yaml:2: unknown key 'seed:1'; a space must follow ':'");
  EXPECT_EQ(read_error("blur: {zzz: 1}\n"),
            "a.yaml:1: unknown key 'zzz' in 'blur'; valid keys: sigma_px, separable");
  EXPECT_EQ(read_error("meshes:\n  - file: x\n  - flie: x\n"),
            "a.yaml:3: unknown key 'flie' in 'meshes[1]'; did you mean 'file'?");
  EXPECT_EQ(read_error("", {"blur.sigma=1"}),
            "--set blur.sigma: unknown key 'sigma' in 'blur'; did you mean 'sigma_px'?");
  EXPECT_EQ(read_error("", {"nothing_like_it=~"}).find("--set nothing_like_it: unknown key"), 0U);
  EXPECT_EQ(read_error("blur:\n  include: b.yaml\n").find("a.yaml:2: unknown key 'include'"), 0U);
}

TEST(Read, KeysOfAnotherChoice) {
  EXPECT_EQ(read_error("radius_m: 1\n"),
            "a.yaml:1: key 'radius_m' does not apply to source: file (it belongs to source: "
            "circle)");
  EXPECT_EQ(read_text("source: circle\nradius_m: 1\n").radius_m, 1);
  EXPECT_EQ(read_error("source: cicle\n"),
            "a.yaml:1: source: unknown value 'cicle'; did you mean 'circle'?");
  EXPECT_EQ(read_error("source: [1]\n"), "a.yaml:1: source: expected text, got a list");
}

TEST(Read, WrongTypes) {
  EXPECT_EQ(read_error("verbose: yes\n"), "a.yaml:1: verbose: expected true or false, got 'yes'");
  EXPECT_EQ(read_error("samples: abc\n"), "a.yaml:1: samples: expected a whole number, got 'abc'");
  EXPECT_EQ(read_error("samples: 7.5\n"), "a.yaml:1: samples: expected a whole number, got '7.5'");
  EXPECT_EQ(read_error("samples: '7'\n"),
            "a.yaml:1: samples: expected a whole number, got the text '7'");
  EXPECT_EQ(read_error("samples:\n"), "a.yaml:1: samples: expected a whole number, got nothing");
  EXPECT_EQ(read_error("ratio: 0,5\n"), "a.yaml:1: ratio: expected a number, got '0,5'");
  EXPECT_EQ(read_error("ratio: [1]\n"), "a.yaml:1: ratio: expected a number, got a list");
  EXPECT_EQ(read_error("name: {a: 1}\n"), "a.yaml:1: name: expected text, got a map");
  EXPECT_EQ(read_error("output: []\n"), "a.yaml:1: output: expected a path, got a list");
  EXPECT_EQ(read_error("blur: 3\n"), "a.yaml:1: blur: expected a map of keys, got '3'");
  EXPECT_EQ(read_error("meshes: {file: x}\n"), "a.yaml:1: meshes: expected a list, got a map");
  EXPECT_EQ(read_error("meshes: [x]\n"), "a.yaml:1: meshes[0]: expected a map of keys, got 'x'");
  EXPECT_EQ(read_error("distortion: [1, 2]\n"),
            "a.yaml:1: distortion: expected a list of 5 values, got 2");
  EXPECT_EQ(read_error("distortion:\n  - 1\n  - x\n  - 1\n  - 1\n  - 1\n"),
            "a.yaml:3: distortion[1]: expected a number, got 'x'");
  EXPECT_EQ(read_error("grid: [1]\n"), "a.yaml:1: grid: expected a map of keys, got a list");
}

TEST(Read, NumbersThatAreNone) {
  for (const char* text : {".nan", "nan", "NaN", "-.inf", "inf", "Infinity", "+.inf"})
    EXPECT_EQ(read_error("ratio: " + std::string(text) + "\n"),
              "a.yaml:1: ratio: expected a finite number, got '" + std::string(text) + "'");
  EXPECT_EQ(read_error("ratio: 1e999\n"),
            "a.yaml:1: ratio: 1e999 is too large or too close to 0 for a number");
  EXPECT_EQ(read_error("samples: 3000000000\n"),
            "a.yaml:1: samples: 3000000000 does not fit; the largest whole number here is "
            "2147483647");
  EXPECT_EQ(read_error("seed: -1\n"), "a.yaml:1: seed: -1 is below 0");
  EXPECT_EQ(read_error("seed: 18446744073709551616\n").find("a.yaml:1: seed: "), 0U);
  for (const char* text : {"0x10", "1_000", "1 2", "--1", "+-1", "1e", "e5", ".", "1f"})
    EXPECT_EQ(read_error("ratio: " + std::string(text) + "\n").find("a.yaml:1: ratio: expected"),
              0U)
        << text;
}

TEST(Read, Ranges) {
  EXPECT_EQ(read_error("samples: 3\n"), "a.yaml:1: samples = 3 is below 6 (allowed: 6 to 1000000)");
  EXPECT_EQ(read_error("samples: 2000000\n"),
            "a.yaml:1: samples = 2000000 is above 1000000 (allowed: 6 to 1000000)");
  EXPECT_EQ(read_error("ratio: 0\n"), "a.yaml:1: ratio = 0 is not above 0");
  EXPECT_EQ(read_error("ratio: 1.5\n"), "a.yaml:1: ratio = 1.5 is above 1");
  EXPECT_EQ(read_error("gain: 10\n"), "a.yaml:1: gain = 10 is not below 10");
  EXPECT_EQ(read_error("gain: 0\n"), "a.yaml:1: gain = 0 is below 0.1");
  EXPECT_EQ(read_error("\nblur: {sigma_px: -1}\n"), "a.yaml:2: blur.sigma_px = -1 is not above 0");
  EXPECT_EQ(read_error("duration_s: 0\n"), "a.yaml:1: duration_s = 0 is not above 0");
  EXPECT_EQ(read_error("meshes:\n- file: x\n  translation: [0, 11, 0]\n"),
            "a.yaml:3: meshes[0].translation[1] = 11 is above 10 (allowed: -10 to 10)");
  EXPECT_EQ(read_error("words: [alpha, gamma]\n"),
            "a.yaml:1: words[1]: unknown value 'gamma'; valid values: alpha, beta");
  EXPECT_EQ(read_error("words: [alpha, beta, alpha]\n"),
            "a.yaml:1: words: expected a list of 0 to 2 values, got 3");
  EXPECT_EQ(read_error("control_poses:\n  - [0, 1]\n"),
            "a.yaml:2: control_poses[0]: expected a list of 7 to 8 values, got 2");
  EXPECT_EQ(read_error("", {"samples=3"}), "--set samples: 3 is below 6 (allowed: 6 to 1000000)");
  EXPECT_EQ(read_error("", {"blur={sigma_px: 0}"}), "--set blur: blur.sigma_px = 0 is not above 0");
}

TEST(Read, ConditionsBetweenKeys) {
  EXPECT_EQ(read_error("verbose: true\nlimits:\n  near_m: 3\n"),
            "a.yaml:3: limits.near_m must be below far_m");
  EXPECT_EQ(read_error("verbose: true\nlimits:\n  far_m: 0.5\n"),
            "a.yaml:3: limits.near_m must be below far_m");
}

TEST(Read, MissingKeysAndFiles) {
  EXPECT_EQ(read_error("meshes:\n  - translation: [0, 0, 0]\n"),
            "a.yaml:2: missing required key 'meshes[0].file'");
  EXPECT_EQ(read_error("\nfile: none.txt\n"), "a.yaml:2: file: no such file '/data/none.txt'");
  EXPECT_EQ(read_error("file: none.zip!/x/y.txt\n"),
            "a.yaml:1: file: no such file '/data/none.zip'");
}

TEST(Check, NamesTheKeyThatCodeHasSetWrong) {
  Options options;
  EXPECT_EQ(error_of([&] { check(options); }), "no error");
  options.blur.sigma_px = -1;
  EXPECT_EQ(error_of([&] { check(options); }), "blur.sigma_px: -1 is not above 0");
  options.blur.sigma_px = 1;
  options.near_m = 5;
  EXPECT_EQ(error_of([&] { check(options); }), "limits.near_m: must be below far_m");
  options.near_m = 1;
  options.ratio = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(error_of([&] { check(options); }).find("ratio: "), 0U);
}

}  // namespace
}  // namespace saccade::config
