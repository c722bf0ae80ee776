#include <gtest/gtest.h>

#include <cmath>

#include "core/config/config.h"
#include "core/config/yaml_emit.h"
#include "tests/unit/core/config/example_options.h"

namespace saccade::config {
namespace {

using testing::Options;

Options unusual_options() {
  Options options;
  options.verbose = true;
  options.samples = 123456;
  options.big = std::numeric_limits<std::int64_t>::min();
  options.seed = std::numeric_limits<std::uint64_t>::max();
  options.ratio = std::nextafter(1.0 / 3.0, 1.0);
  options.gain = 1.1F;
  options.name = "true \"x\": # \\ \n\t\x01 \xc3\xa9";
  options.output = "/tmp/a folder/b";
  options.source = testing::Source::kCircle;
  options.radius_m = 1e-5;
  options.distortion = {5e-324, 1e300, -0.0, 1e22, 123456789.123};
  options.control_poses = {{1, 2}, {}, {3, 4, 5, 6, 7, 8, 0.1}};
  options.control_poses = {{1, 2, 3, 4, 5, 6, 7}, {0, 1, 2, 3, 0, 0, 0, 1}};
  options.words = {"alpha", "beta"};
  options.duration_s = 0.1;
  options.grid = {{"a.b", {"1", "true", ""}}, {"c d", {}}};
  options.extra_blur = testing::Blur{.sigma_px = 7, .separable = false};
  options.meshes = {{"/m.obj", {1, 2, 3}}, {"/n.obj", {0.1, 0.2, 0.3}}};
  options.embedded = "a: 1\nb:\n  - c: \"yes\"\n    d: [1, x]\n";
  return options;
}

TEST(Print, ReadsBackToTheSameStruct) {
  const Options options = unusual_options();
  const std::string text = print(options);
  const Options again = read<Options>(parse(text, "printed.yaml"));
  EXPECT_EQ(again.verbose, options.verbose);
  EXPECT_EQ(again.samples, options.samples);
  EXPECT_EQ(again.big, options.big);
  EXPECT_EQ(again.seed, options.seed);
  EXPECT_EQ(again.ratio, options.ratio);
  EXPECT_EQ(again.gain, options.gain);
  EXPECT_EQ(again.name, options.name);
  EXPECT_EQ(again.output, options.output);
  EXPECT_EQ(again.source, options.source);
  EXPECT_EQ(again.radius_m, options.radius_m);
  EXPECT_EQ(again.distortion, options.distortion);
  EXPECT_EQ(again.control_poses, options.control_poses);
  EXPECT_EQ(again.words, options.words);
  EXPECT_EQ(again.duration_s, options.duration_s);
  EXPECT_EQ(again.grid, options.grid);
  EXPECT_EQ(again.extra_blur->sigma_px, 7);
  EXPECT_FALSE(again.extra_blur->separable);
  EXPECT_EQ(again.meshes[1].file, "/n.obj");
  EXPECT_EQ(again.meshes[1].translation, options.meshes[1].translation);
  EXPECT_EQ(again.embedded, options.embedded);
  EXPECT_EQ(print(again), text);
}

TEST(Print, WhatIsAbsentStaysAbsent) {
  Options defaults;
  defaults.duration_s = 3;
  defaults.extra_blur.emplace();
  defaults.meshes.resize(1);
  const std::string text = print(Options{});
  const Options again = read(parse(text, "printed.yaml"), defaults);
  EXPECT_EQ(again.duration_s, std::nullopt);
  EXPECT_FALSE(again.extra_blur);
  EXPECT_TRUE(again.meshes.empty());
  EXPECT_EQ(print(again), text);
}

TEST(Print, TextsOfTreesStayTheSameHoweverTheyWereWritten) {
  for (const char* text : {"/a/b.yaml", "'/a/b.yaml'", "./a.yaml", "word", "'a b'", "1", "'1'",
                           "-.5", "true", "'true'", "~", "a/b-c_d.e"}) {
    const std::string once = to_yaml(parse("k: [" + std::string(text) + "]\n", "a.yaml").root());
    EXPECT_EQ(to_yaml(parse(once, "b.yaml").root()), once) << text;
  }
}

TEST(Print, IsPlainYaml) {
  Options options;
  options.source = testing::Source::kCircle;
  options.meshes = {{"/m.obj", {1, 2, 3}}};
  options.radius_m = 1e-7;
  EXPECT_EQ(print(options),
            "verbose: false\nsamples: 500\nbig: -1\nseed: 1\nratio: 0.4\ngain: 0.1\nname: plain\n"
            "output: \"\"\nsource: circle\nradius_m: 1.0e-07\ndistortion: [0, 0, 0, 0, 0]\n"
            "control_poses: []\nwords: []\nduration_s: ~\ngrid: {}\nlimits:\n  near_m: 1\n"
            "  far_m: 2\nblur:\n  sigma_px: 1\n  separable: true\nextra_blur: ~\nmeshes:\n"
            "  - file: /m.obj\n    translation: [1, 2, 3]\nembedded: {}\n");
}

TEST(Print, DocumentedNamesHelpAndRanges) {
  const std::string text = print_documented(Options{});
  EXPECT_NE(text.find("samples: 500  # points per iteration [6 to 1000000]\n"), std::string::npos);
  EXPECT_NE(text.find("ratio: 0.4  # a fraction [> 0, <= 1]\n"), std::string::npos);
  EXPECT_NE(text.find("source: file  # where poses come from [file, circle]\n"), std::string::npos);
  EXPECT_NE(text.find("blur:  # of the template\n"), std::string::npos);
  EXPECT_EQ(print(read<Options>(parse(text, "printed.yaml"))), print(Options{}));
}

}  // namespace
}  // namespace saccade::config
