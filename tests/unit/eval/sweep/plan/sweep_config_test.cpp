#include "eval/sweep/plan/sweep_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/error_of.h"
#include "tests/unit/eval/sweep/sweep_files.h"

namespace saccade {
namespace {

using ::testing::ElementsAre;
using testing::error_of;
using ::testing::HasSubstr;
using testing::read_sweep;
using testing::TemporaryFolder;

TEST(SweepConfig, ReadsWhatAFileStates) {
  const TemporaryFolder folder;
  const SweepConfig sweep = read_sweep(folder,
                                       "datasets:\n"
                                       "  - {simulate: walls.yaml, set: {duration_s: 0.1}}\n"
                                       "  - {name: mine, path: recorded/}\n"
                                       "configurations:\n"
                                       "  - {file: fast.yaml}\n"
                                       "  - {name: plain}\n"
                                       "variants: [{name: as it is}, {name: b, set: {x.y: ~}}]\n"
                                       "grid: {b.z: [1, 2e3], a: [[1, two], {k: v}]}\n"
                                       "seeds: [4, 5]\n");
  ASSERT_EQ(sweep.datasets.size(), 2U);
  EXPECT_EQ(sweep.datasets[0].name, "walls");
  EXPECT_EQ(sweep.datasets[0].simulate, folder.path() / "walls.yaml");
  EXPECT_EQ(sweep.datasets[1].name, "mine");
  EXPECT_EQ(sweep.configurations[0].name, "fast");
  EXPECT_EQ(sweep.configurations[1].file, std::nullopt);
  EXPECT_EQ(sweep.variants[1].set[0].key, "x.y");
  EXPECT_EQ(sweep.variants[1].set[0].value, "~");
  ASSERT_EQ(sweep.grid.size(), 2U);
  EXPECT_EQ(sweep.grid[0].key, "b.z") << "in the order of the file";
  EXPECT_THAT(sweep.grid[0].values, ElementsAre("1", "2e3"));
  EXPECT_THAT(sweep.grid[1].values, ElementsAre("[1, two]", "{k: v}"));
  EXPECT_THAT(sweep.seeds, ElementsAre(4U, 5U));
}

TEST(SweepConfig, ReadsABenchmark) {
  const TemporaryFolder folder;
  const SweepConfig sweep = read_sweep(
      folder,
      "datasets: [{simulate: walls.yaml}, {path: recorded}]\n"
      "configurations: [{module: depth, file: fast.yaml, datasets: [walls]}]\n"
      "expected: [{configuration: depth fast, metric: depth.rel_median, at_most: 0.1}]\n");
  EXPECT_TRUE(sweep.configurations[0].runs_over("walls"));
  EXPECT_FALSE(sweep.configurations[0].runs_over("recorded"));
  EXPECT_EQ(sweep.expected.at(0).at_most, 0.1);
  EXPECT_EQ(sweep.expected[0].at_least, std::nullopt);
}

TEST(SweepConfig, WhatEventsAreScoredAgainstMustComeBefore) {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& datasets, const std::string& more = "") {
    return error_of([&] { return read_sweep(folder, "datasets: [" + datasets + "]\n" + more); });
  };
  const std::string truth = "{name: exact, simulate: walls.yaml}, ";
  EXPECT_EQ(error(truth + "{name: b, simulate: walls.yaml, against: exact}"), "no error");
  EXPECT_EQ(error(truth + "{adapter: fast.yaml, against: exact}"), "no error");
  EXPECT_THAT(error(truth + "{name: b, simulate: walls.yaml, against: exakt}"),
              HasSubstr("'exakt', which 'b' is scored against, is not a dataset before it; did you "
                        "mean 'exact'?"));
  EXPECT_THAT(error(truth + "{name: b, simulate: walls.yaml, against: b}"),
              HasSubstr("is not a dataset before it"));
  EXPECT_THAT(error("{adapter: fast.yaml}"), HasSubstr("needs 'against'"));
  EXPECT_THAT(error("{path: recorded, simulate: walls.yaml}"), HasSubstr("one of them alone"));
  EXPECT_THAT(error(truth + "{path: recorded, against: exact}"),
              HasSubstr("'set' and 'against' belong to what makes one"));
  EXPECT_THAT(error(truth + "{adapter: fast.yaml, against: exact, seeds: [1]}"),
              HasSubstr("belong to 'simulate'"));
  EXPECT_THAT(error("{name: exact, simulate: walls.yaml, seeds: [1, 2]}, "
                    "{name: b, simulate: walls.yaml, against: exact}"),
              HasSubstr("'b' must have the seeds of 'exact'"));
  EXPECT_THAT(error(truth + "{name: a, adapter: fast.yaml, against: exact}, "
                            "{name: b, adapter: fast.yaml, against: a}"),
              HasSubstr("'a' is of an external simulator and no truth"));
  EXPECT_THAT(error(truth + "{name: b, simulate: walls.yaml, against: exact}",
                    "configurations: [{name: c}]\n"),
              HasSubstr("sweeps without 'configurations'"));
}

TEST(SweepConfig, WhatABenchmarkNamesMustBeThere) {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& configurations, const std::string& more = "") {
    return error_of([&] {
      return read_sweep(folder,
                        "datasets: [{simulate: walls.yaml}, {path: recorded}]\n"
                        "configurations: [" +
                            configurations + "]\n" + more);
    });
  };
  const std::string a = "{name: a, datasets: [walls]}";
  EXPECT_THAT(error("{name: a, datasets: [wals]}"), HasSubstr("'wals' is not a dataset"));
  EXPECT_THAT(error("{name: b, from: a}, " + a), HasSubstr("not a configuration before it"));
  EXPECT_THAT(error(a + ", {name: b, from: a}"),
              HasSubstr("'b' runs over recorded, but 'a', which it starts from, does not"));
  EXPECT_EQ(error(a + ", {name: b, from: a, datasets: [walls]}"), "no error");
  EXPECT_THAT(error("{name: a, seeds: [1]}, {name: b, from: a, seeds: [2]}"),
              HasSubstr("'b' has the seed 2, but 'a', which it starts from, does not"));
  EXPECT_THAT(error(a, "expected: [{configuration: c, metric: m, at_most: 1}]\n"),
              HasSubstr("'c' is not a configuration"));
  EXPECT_THAT(error(a, "expected: [{configuration: a, metric: m}]\n"),
              HasSubstr("needs 'at_most' or 'at_least'"));
}

TEST(SweepConfig, NamesADatasetAfterItsFolder) {
  const TemporaryFolder folder;
  for (const char* path : {"recorded", "recorded/", "./recorded"})
    EXPECT_EQ(
        read_sweep(folder, "datasets: [{path: " + std::string(path) + "}]\n").datasets[0].name,
        "recorded");
}

TEST(SweepConfig, PathsInSettingsAreRelativeToTheFileWhenTheySaySo) {
  const TemporaryFolder folder;
  const SweepConfig sweep = read_sweep(
      folder, "datasets: [{simulate: walls.yaml, set: {a: ./x.obj, b: x.obj, c: [../y]}}]\n");
  const Settings& set = sweep.datasets[0].set;
  EXPECT_THAT(set[0].value, HasSubstr((folder.path() / "x.obj").string()));
  EXPECT_EQ(set[1].value, "x.obj");
  EXPECT_THAT(set[2].value, HasSubstr((folder.path().parent_path() / "y").string()));
}

TEST(SweepConfig, PrintsWhatItReads) {
  const TemporaryFolder folder;
  const std::string printed = config::print_documented(read_sweep(
      folder,
      "datasets: [{simulate: walls.yaml, set: {trajectory: {source: circle}}, seeds: [2]}]\n"
      "configurations: [{file: fast.yaml, set: {t: 'yes', n: 007}}]\n"
      "variants: [{name: 'a: b', set: {x: ~, y: \"q'\\\"\"}}]\n"
      "grid: {a.b: [{k: [1, 2]}, ~, text with blanks]}\n"));
  const auto again = config::read<SweepConfig>(config::load(folder.write("again.yaml", printed)));
  EXPECT_EQ(config::print_documented(again), printed);
}

TEST(SweepConfig, SaysWhatIsWrongAndWhere) {
  const TemporaryFolder folder;
  const std::string data = "datasets: [{simulate: walls.yaml}]\n";
  const std::string runs = data + "configurations: [{file: fast.yaml}]\n";
  const auto error = [&](const std::string& yaml) {
    return error_of([&] { return read_sweep(folder, yaml); });
  };
  EXPECT_THAT(error("dataset: []\n"), HasSubstr("did you mean 'datasets'?"));
  EXPECT_THAT(error("seeds: [1]\n"), HasSubstr("missing required key 'datasets'"));
  EXPECT_THAT(error("datasets: []\n"), HasSubstr("sweep.yaml:1: datasets"));
  EXPECT_THAT(error(data + "configurations: [{file: fast.yaml, adapter: fast.yaml}]\n"),
              HasSubstr("beside 'adapter'"));
  EXPECT_THAT(error(data + "configurations: [{adapter: fast.yaml}]\ngrid: {a.b: [1]}\n"),
              HasSubstr("keys of the module"));
  EXPECT_THAT(error("datasets: [{}]\n"), HasSubstr("must be stated, or 'simulate'"));
  EXPECT_THAT(error("datasets: [{path: recorded, simulate: walls.yaml}]\n"),
              HasSubstr("one of them alone"));
  EXPECT_THAT(error("datasets: [{path: recorded, seeds: [1]}]\n"), HasSubstr("belong to"));
  EXPECT_THAT(error("datasets: [{path: nowhere}]\n"), HasSubstr("nowhere"));
  EXPECT_THAT(error("datasets: [{simulate: walls.yaml}, {simulate: walls.yaml}]\n"),
              HasSubstr("holds the name 'walls' twice"));
  EXPECT_THAT(error(data + "grid: {a: [1]}\n"), HasSubstr("sweep.yaml:2: grid needs"));
  EXPECT_THAT(error(data + "variants: [{name: a}]\n"), HasSubstr("variants need"));
  EXPECT_THAT(error(runs + "grid: {a: []}\n"), HasSubstr("sweep.yaml:3: grid.a holds no values"));
  EXPECT_THAT(error(runs + "grid: {a: 3}\n"), HasSubstr("grid.a"));
  EXPECT_THAT(error(runs + "grid: {a: [1, 2, 1]}\n"), HasSubstr("holds 1 twice"));
  EXPECT_THAT(error(runs + "grid: {seed: [1]}\n"), HasSubstr("state it in 'seeds'"));
  EXPECT_THAT(error(runs + "seeds: [1, 1]\n"), HasSubstr("holds a seed twice"));
  EXPECT_THAT(error(runs + "variants: [{set: {a: 1}}]\n"), HasSubstr("variants[0].name"));
  EXPECT_THAT(error(runs + "timing: true\nthreads: 2\n"), HasSubstr("must be 1"));
  EXPECT_THAT(error(runs + "repeat: 0\n"), HasSubstr("repeat"));
}

TEST(SweepConfig, GoesOnWithoutOptionalDatasetsThatAreNotHere) {
  const TemporaryFolder folder;
  SweepConfig sweep = read_sweep(folder,
                                 "datasets:\n"
                                 "  - {name: here, path: recorded/, optional: true}\n"
                                 "  - {name: gone, path: nowhere/, optional: true}\n"
                                 "configurations:\n"
                                 "  - {name: all}\n"
                                 "  - {name: both, datasets: [here, gone]}\n"
                                 "  - {name: one, datasets: [gone]}\n"
                                 "expected:\n"
                                 "  - {configuration: one, metric: success, at_least: 1}\n"
                                 "  - {configuration: all, datasets: [gone], metric: success, "
                                 "at_least: 1}\n"
                                 "  - {configuration: all, metric: success, at_least: 1}\n");
  const auto messages = leave_out_absent(sweep);
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_THAT(messages[0], HasSubstr("gone is left out: "));
  EXPECT_THAT(sweep.dataset_names(), ElementsAre("here"));
  ASSERT_EQ(sweep.configurations.size(), 2U);
  EXPECT_TRUE(sweep.configurations[0].datasets.empty());
  EXPECT_THAT(sweep.configurations[1].datasets, ElementsAre("here"));
  ASSERT_EQ(sweep.expected.size(), 1U);
  EXPECT_TRUE(sweep.expected[0].datasets.empty());
  EXPECT_THAT(
      error_of([&] {
        return read_sweep(folder, "datasets: [{simulate: walls.yaml, optional: true}]").title;
      }),
      HasSubstr("belongs to 'path'"));
}

}  // namespace
}  // namespace saccade
