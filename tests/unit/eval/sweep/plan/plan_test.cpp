#include "eval/sweep/plan/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/unit/eval/sweep/sweep_files.h"

namespace saccade {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Not;
using testing::read_sweep;
using ::testing::SizeIs;
using testing::TemporaryFolder;

std::vector<std::string> names(const std::vector<SweepJob>& jobs) {
  std::vector<std::string> all;
  for (const SweepJob& job : jobs) all.push_back(job.name);
  return all;
}

SweepPlan plan(const TemporaryFolder& folder, const std::string& yaml) {
  return plan_sweep(read_sweep(folder, yaml), folder.path() / "out");
}

TEST(SweepPlan, ExpandsInTheOrderOfTheFile) {
  const TemporaryFolder folder;
  const SweepPlan sweep = plan(folder,
                               "datasets: [{simulate: walls.yaml}, {path: recorded}]\n"
                               "configurations: [{file: fast.yaml}]\n"
                               "grid: {align.samples: [50, 25], map.thin: [true, false]}\n"
                               "seeds: [1, 2]\n");
  EXPECT_THAT(names(sweep.simulations), ElementsAre("walls"));
  ASSERT_THAT(sweep.runs, SizeIs(16));
  const std::vector<std::string> all = names(sweep.runs);
  EXPECT_THAT(std::vector<std::string>(all.begin(), all.begin() + 5),
              ElementsAre("walls_fast_samples-50_thin-true_seed-1",
                          "walls_fast_samples-50_thin-true_seed-2",
                          "walls_fast_samples-50_thin-false_seed-1",
                          "walls_fast_samples-50_thin-false_seed-2",
                          "walls_fast_samples-25_thin-true_seed-1"));
  EXPECT_EQ(all[8], "recorded_fast_samples-50_thin-true_seed-1");
  EXPECT_EQ(sweep.runs[0].made_by, 0U);
  EXPECT_EQ(sweep.runs[8].made_by, std::nullopt);
}

TEST(SweepPlan, ARunThatStartsFromAnotherComesInALaterWave) {
  const TemporaryFolder folder;
  const SweepPlan sweep =
      plan(folder,
           "datasets: [{simulate: walls.yaml}, {path: recorded}]\n"
           "configurations:\n"
           "  - {module: odometry, file: fast.yaml}\n"
           "  - {name: refined, module: refine, datasets: [recorded], from: odometry fast}\n"
           "  - {name: deep, module: depth, poses_from: odometry fast, repeat: 3}\n"
           "seeds: [1, 2]\n");
  EXPECT_THAT(
      names(sweep.runs),
      ElementsAre("walls_odometry-fast_seed-1", "walls_odometry-fast_seed-2", "walls_deep_seed-1",
                  "walls_deep_seed-2", "recorded_odometry-fast_seed-1",
                  "recorded_odometry-fast_seed-2", "recorded_refined_seed-1",
                  "recorded_refined_seed-2", "recorded_deep_seed-1", "recorded_deep_seed-2"));
  EXPECT_EQ(SweepPlan::stages(sweep.runs), 2);
  EXPECT_EQ(sweep.runs[4].stage, 0);
  const SweepJob& refined = sweep.runs[7];
  EXPECT_EQ(refined.stage, 1);
  EXPECT_THAT(refined.sources, ElementsAre(5U));
  EXPECT_THAT(refined.source_runs, ElementsAre(sweep.runs[5].output));
  const std::vector<std::string>& call = refined.commands.at(0);
  EXPECT_EQ(call[1], "refine");
  const auto option = std::find(call.begin(), call.end(), "--from");
  ASSERT_LT(option + 1, call.end());
  EXPECT_EQ(option[1], sweep.runs[5].output);
  const std::vector<std::string>& depth = sweep.runs[3].commands.at(0);
  EXPECT_NE(std::find(depth.begin(), depth.end(), "--poses-from"), depth.end());
  const auto repeat = std::find(depth.begin(), depth.end(), "--repeat");
  ASSERT_LT(repeat + 1, depth.end());
  EXPECT_EQ(repeat[1], "3");
}

TEST(SweepPlan, AConfigurationMayHaveSeedsOfItsOwn) {
  const TemporaryFolder folder;
  const SweepPlan sweep = plan(folder,
                               "datasets: [{path: recorded}]\n"
                               "configurations: [{file: fast.yaml}, {name: b, seeds: [2]}]\n"
                               "seeds: [1, 2]\n");
  EXPECT_THAT(names(sweep.runs),
              ElementsAre("recorded_fast_seed-1", "recorded_fast_seed-2", "recorded_b_seed-2"));
}

TEST(SweepPlan, AnAdapterRunsAnExternalProgram) {
  const TemporaryFolder folder;
  const SweepPlan sweep = plan(folder,
                               "datasets: [{path: recorded}]\n"
                               "configurations: [{file: fast.yaml}, {adapter: accurate.yaml}]\n");
  ASSERT_THAT(sweep.runs, SizeIs(2));
  EXPECT_EQ(sweep.runs[0].commands[0][1], "track");
  const std::string root = folder.path();
  EXPECT_EQ(sweep.runs[1].name, "recorded_accurate");
  EXPECT_EQ(sweep.runs[1].point.module, "track") << "the table that it stands in";
  EXPECT_THAT(sweep.runs[1].commands[0],
              ElementsAre("run", "external", "--data", root + "/recorded", "-o",
                          root + "/out/runs/recorded_accurate", "-c", root + "/accurate.yaml",
                          "--repeat", "1", "--threads", "1"));
}

TEST(SweepPlan, EventsAreScoredAgainstThoseOfAnEarlierDataset) {
  const TemporaryFolder folder;
  const SweepPlan sweep =
      plan(folder,
           "datasets:\n"
           "  - {name: exact, simulate: walls.yaml}\n"
           "  - {name: coarse, simulate: walls.yaml, set: {a: 1}, against: exact}\n"
           "  - {name: theirs, adapter: accurate.yaml, set: {b: 2}, against: exact}\n"
           "  - {name: measured, path: recorded}\n"
           "  - {name: modelled, simulate: walls.yaml, against: measured}\n");
  const std::string root = folder.path(), out = root + "/out/";
  ASSERT_THAT(names(sweep.simulations), ElementsAre("exact", "coarse", "theirs", "modelled"));
  EXPECT_TRUE(sweep.runs.empty());
  const SweepJob& coarse = sweep.simulations[1];
  EXPECT_THAT(coarse.commands,
              ElementsAre(ElementsAre("simulate", root + "/walls.yaml", "-o", out + "data/coarse",
                                      "--cached", "--set", "a=1"),
                          ElementsAre("eval", "--events", out + "data/coarse", "--against",
                                      out + "data/exact", "-o", out + "scores/coarse")));
  EXPECT_EQ(coarse.made_by, 0U);
  EXPECT_EQ(coarse.stage, 1);
  EXPECT_STREQ(coarse.marker(), "dataset.yaml");
  EXPECT_EQ(coarse.scores, out + "scores/coarse/metrics.json");
  const SweepJob& theirs = sweep.simulations[2];
  EXPECT_THAT(
      theirs.commands,
      ElementsAre(
          ElementsAre("run", "external", "--data", out + "data/exact", "-o", out + "data/theirs",
                      "-c", root + "/accurate.yaml", "--set", "b=2", "--threads", "1"),
          ElementsAre("eval", "--events", out + "data/theirs/events.h5", "--against",
                      out + "data/exact", "-o", out + "scores/theirs")));
  EXPECT_STREQ(theirs.marker(), "run.yaml");
  EXPECT_EQ(sweep.simulations[3].commands[1][4], root + "/recorded");
  EXPECT_EQ(sweep.simulations[3].stage, 0);
  EXPECT_EQ(SweepPlan::stages(sweep.simulations), 2);
}

TEST(SweepPlan, ATruthOfSeveralSeedsIsThatOfTheSameSeed) {
  const TemporaryFolder folder;
  const SweepPlan sweep =
      plan(folder,
           "datasets:\n"
           "  - {name: exact, simulate: walls.yaml, seeds: [1, 2]}\n"
           "  - {name: coarse, simulate: walls.yaml, seeds: [1, 2], against: exact}\n"
           "  - {name: theirs, adapter: accurate.yaml, against: exact}\n");
  ASSERT_THAT(sweep.simulations, SizeIs(6));
  EXPECT_EQ(sweep.simulations[4].dataset, sweep.simulations[0].output);
  EXPECT_EQ(sweep.simulations[5].dataset, sweep.simulations[1].output);
  EXPECT_EQ(sweep.simulations[5].name, "theirs-2");
  EXPECT_THAT(sweep.simulations[5].commands[0], Not(Contains("--seed")));
  EXPECT_EQ(sweep.simulations[2].dataset, sweep.simulations[0].output);
  EXPECT_EQ(sweep.simulations[3].dataset, sweep.simulations[1].output);
}

TEST(SweepPlan, MakesCommandLines) {
  const TemporaryFolder folder;
  const SweepPlan sweep =
      plan(folder,
           "datasets: [{simulate: walls.yaml, set: {duration_s: 0.1}, seeds: [7]}]\n"
           "configurations: [{file: fast.yaml, set: {a: 1}}]\n"
           "variants: [{name: v, set: {b: [1, 2]}}]\n"
           "grid: {c.d: [x]}\n"
           "seeds: [3]\nrepeat: 4\nduration_s: 0.05\n");
  const std::string root = folder.path(), out = root + "/out/";
  EXPECT_THAT(sweep.simulations.at(0).commands,
              ElementsAre(ElementsAre("simulate", root + "/walls.yaml", "-o", out + "data/walls",
                                      "--cached", "--set", "duration_s=0.1", "--seed", "7")));
  EXPECT_THAT(
      sweep.runs.at(0).commands,
      ElementsAre(ElementsAre("run", "track", "--data", out + "data/walls", "-o",
                              out + "runs/walls_fast_v_d-x_seed-3", "-c", root + "/fast.yaml",
                              "--set", "a=1", "--set", "b=[1, 2]", "--set", "c.d=x", "--seed", "3",
                              "--duration-s", "0.05", "--repeat", "4", "--threads", "1"),
                  ElementsAre("eval", out + "runs/walls_fast_v_d-x_seed-3", "--threads", "1")));
}

TEST(SweepPlan, NamesAreUniqueAndFitAFileSystem) {
  const TemporaryFolder folder;
  const SweepPlan sweep = plan(
      folder,
      "datasets: [{simulate: walls.yaml, seeds: [1, 2]}, {name: walls 1, path: recorded}]\n"
      "configurations: [{name: A/b, file: fast.yaml}, {name: a b}]\n"
      "variants: [{name: ..}, {name: //}, {name: " +
          std::string(300, 'x') + "}]\n" + "grid: {a.k: [-1, 1, '1'], b.k: [{x: 1}, [x, 1]]}\n");
  std::vector<std::string> all = names(sweep.runs);
  for (const std::string& name : names(sweep.simulations)) all.push_back(name);
  std::set<std::string> folded;
  for (std::string name : all) {
    EXPECT_LT(name.size(), 220U);
    EXPECT_EQ(name.find_first_of("/ {}[]:'\""), std::string::npos) << name;
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    EXPECT_TRUE(folded.insert(name).second) << name;
  }
  EXPECT_THAT(names(sweep.simulations), ElementsAre("walls-1", "walls-2"));
  EXPECT_EQ(sweep.runs[0].name, "walls-1_A-b__.._a.k--1_b.k-x-1") << "two axes end alike";
}

TEST(SweepPlan, WithoutConfigurationsSimulatesOnly) {
  const TemporaryFolder folder;
  const SweepPlan sweep = plan(folder, "datasets: [{simulate: walls.yaml}]\nseeds: [1, 2]\n");
  EXPECT_THAT(sweep.simulations, SizeIs(1));
  EXPECT_THAT(sweep.runs, SizeIs(0));
  EXPECT_EQ(&sweep.rows(), &sweep.simulations);
}

}  // namespace
}  // namespace saccade
