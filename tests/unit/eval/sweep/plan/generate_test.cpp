#include "eval/sweep/plan/generate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "eval/sweep/plan/calibration_run.h"
#include "tests/support/error_of.h"
#include "tests/unit/eval/sweep/sweep_files.h"

namespace saccade {
namespace {

using ::testing::ElementsAre;
using testing::error_of;
using ::testing::HasSubstr;
using testing::read_sweep;
using testing::TemporaryFolder;

const std::string kGenerate =
    "generate:\n"
    "  name: some\n"
    "  count: 3\n"
    "  first: 416\n"
    "  set: {duration_s: 0.1, b: 1}\n"
    "  draw: {a: {uniform: [0, 1]}, c: [{integer: [5, 5]}]}\n"
    "  scenes:\n"
    "    - {simulate: walls.yaml, set: {b: 2}, draw: {a: {integer: [8, 8]}, d: {choose: [e]}}}\n";

TEST(Generate, PlansADatasetForEachIndex) {
  const TemporaryFolder folder;
  const SweepConfig sweep = read_sweep(folder, kGenerate);
  const SweepPlan plan = plan_sweep(sweep, "/out");
  ASSERT_EQ(plan.simulations.size(), 3U);
  const SweepJob& job = plan.simulations[1];
  EXPECT_EQ(job.name, "some-000417");
  EXPECT_EQ(job.output, "/out/data/some-000417");
  const std::string seed = std::to_string(*job.point.dataset_seed);
  EXPECT_THAT(job.commands,
              ElementsAre(ElementsAre("simulate", folder.path() / "walls.yaml", "-o",
                                      "/out/data/some-000417", "--threads", "1", "--set",
                                      "duration_s=0.1", "--set", "b=1", "--set", "b=2", "--set",
                                      "a=8", "--set", "c=[5]", "--set", "d=e", "--seed", seed)));
  const GeneratedDataset dataset = generated_dataset(*sweep.generate, 417);
  EXPECT_THAT(dataset.sampled,
              ElementsAre(std::pair("a", "8"), std::pair("c.0", "5"), std::pair("d", "e")));
}

const std::string kInTurn =
    "generate:\n"
    "  count: 12\n"
    "  scenes_in_turn: true\n"
    "  draw: {a: {uniform: [0, 1]}}\n"
    "  cases:\n"
    "    - {name: slow, set: {c: 1}, draw: {a: {integer: [5, 5]}}}\n"
    "    - {name: fast, weight: 2, set: {c: 2}, draw: {a: {integer: [9, 9]}}}\n"
    "  scenes:\n"
    "    - {name: first, simulate: walls.yaml}\n"
    "    - {name: second, simulate: walls.yaml, draw: {b: {integer: [3, 3]}}}\n"
    "    - {name: third, simulate: walls.yaml}\n";

TEST(Generate, ScenesMayTakeTurns) {
  const TemporaryFolder folder;
  const SweepConfig sweep = read_sweep(folder, kInTurn);
  for (std::uint64_t i = 0; i < 12; ++i)
    EXPECT_EQ(generated_dataset(*sweep.generate, i).scene, &sweep.generate->scenes[i % 3]);
}

TEST(Generate, PairedScenesShareTheirSamples) {
  const TemporaryFolder folder;
  SweepConfig sweep = read_sweep(folder, kInTurn);
  const GenerateConfig unpaired = *sweep.generate;
  sweep.generate->paired = true;
  const auto value_of_a = [](const GeneratedDataset& dataset) { return dataset.sampled.front(); };
  for (std::uint64_t i = 0; i < 12; ++i) {
    const GeneratedDataset dataset = generated_dataset(*sweep.generate, i);
    const GeneratedDataset first = generated_dataset(unpaired, i / 3);
    EXPECT_EQ(dataset.scene, &sweep.generate->scenes[i % 3]);
    EXPECT_EQ(dataset.part->name, first.part->name);
    EXPECT_EQ(dataset.seed, first.seed);
    EXPECT_EQ(value_of_a(dataset), value_of_a(first));
    EXPECT_EQ(dataset.index, i);
  }
}

TEST(Generate, ACaseIsSampledAsAWholeByItsWeight) {
  const TemporaryFolder folder;
  const SweepConfig sweep = read_sweep(folder, kInTurn);
  int fast = 0;
  for (std::uint64_t i = 0; i < 3000; ++i) {
    const GeneratedDataset dataset = generated_dataset(*sweep.generate, i);
    const bool is_fast = dataset.part->name == "fast";
    fast += is_fast ? 1 : 0;
    const auto value = [&](const std::string& key) {
      const auto has_key = [&](const Setting& setting) { return setting.key == key; };
      return std::find_if(dataset.settings.begin(), dataset.settings.end(), has_key)->value;
    };
    ASSERT_EQ(value("a"), is_fast ? "9" : "5");
    ASSERT_EQ(value("c"), is_fast ? "2" : "1");
  }
  // Binomial with p = 2/3: sigma is 26.
  EXPECT_NEAR(fast, 2000, 4 * 26);
}

TEST(Generate, ConfigurationsRunOverGeneratedDatasets) {
  const TemporaryFolder folder;
  const SweepConfig sweep = read_sweep(folder, kInTurn +
                                                   "configurations:\n"
                                                   "  - {name: all}\n"
                                                   "  - {name: some, datasets: [second]}\n"
                                                   "  - {name: even, every: 2, poses_from: all}\n");
  const SweepPlan plan = plan_sweep(sweep, "/out");
  ASSERT_EQ(plan.runs.size(), 12U + 4U + 6U);
  EXPECT_EQ(plan.runs[0].name, "dataset-000000_all");
  EXPECT_EQ(plan.runs[0].dataset, "/out/data/dataset-000000");
  EXPECT_EQ(plan.runs[0].made_by, 0U);
  // Dataset 4 shows the second scene, and reads the run of the same dataset.
  const auto even = std::find_if(plan.runs.begin(), plan.runs.end(), [](const SweepJob& job) {
    return job.name == "dataset-000004_even";
  });
  ASSERT_NE(even, plan.runs.end());
  EXPECT_EQ(even->point.dataset, "second");
  EXPECT_EQ(plan.runs[even->sources.at(0)].name, "dataset-000004_all");
  EXPECT_TRUE(even->point.differs_in_seed_only(
      std::find_if(plan.runs.begin(), plan.runs.end(), [](const SweepJob& job) {
        return job.name == "dataset-000010_even";
      })->point));
}

TEST(Generate, ARunThatStartsFromAnotherNeedsItForEachDataset) {
  const TemporaryFolder folder;
  const auto problem = [&](const std::string& configurations) {
    return error_of([&] { (void)read_sweep(folder, kInTurn + configurations); });
  };
  EXPECT_THAT(problem("configurations: [{name: a, every: 2}, {name: b, poses_from: a}]\n"),
              HasSubstr("'every' must be a multiple of 2"));
  EXPECT_THAT(problem("configurations: [{name: a, datasets: [secnod]}]\n"), HasSubstr("'second'"));
  EXPECT_THAT(error_of([&] {
                (void)read_sweep(folder,
                                 "datasets: [{simulate: walls.yaml}]\n"
                                 "configurations: [{name: a, every: 2}]\n");
              }),
              HasSubstr("for generated datasets"));
}

TEST(Generate, ADatasetIsTheSameInEverySubset) {
  const TemporaryFolder folder;
  const SweepConfig few = read_sweep(folder, kGenerate);
  SweepConfig many = few;
  many.generate->first = 0;
  many.generate->count = 1000;
  const SweepPlan plan = plan_sweep(many, "/out");
  EXPECT_EQ(plan.simulations[417].settings, plan_sweep(few, "/out").simulations[1].settings);
  EXPECT_NE(plan.simulations[417].settings, plan.simulations[418].settings) << "the seed differs";
}

TEST(Generate, DrawsScenesByTheirWeights) {
  const TemporaryFolder folder;
  const SweepConfig sweep = read_sweep(
      folder,
      "generate: {count: 1, scenes: [{simulate: walls.yaml, weight: 3}, {simulate: fast.yaml}]}\n");
  std::map<std::string, int> counts;
  constexpr int kCount = 2000;
  for (int i = 0; i < kCount; ++i)
    ++counts[generated_dataset(*sweep.generate, static_cast<std::uint64_t>(i)).scene->name];
  EXPECT_NEAR(counts["walls"], 0.75 * kCount, 5 * std::sqrt(kCount * 0.75 * 0.25));
}

TEST(Generate, EveryBlockHasItsPartsAndADatasetKeepsItsOwn) {
  const TemporaryFolder folder;
  const std::string yaml =
      "generate: {count: 1, seed: 7, split: {train: 80, val: 10, test: 10}, "
      "scenes: [{simulate: walls.yaml}]}\n";
  const SweepConfig sweep = read_sweep(folder, yaml);
  std::string orders;
  for (std::uint64_t block = 0; block < 20; ++block) {
    std::map<std::string, int> counts;
    for (std::uint64_t i = 0; i < 10; ++i) {
      const std::string split = generated_dataset(*sweep.generate, 10 * block + i).split;
      ++counts[split];
      orders += split[1];
    }
    EXPECT_EQ(counts["train"], 8);
    EXPECT_EQ(counts["val"], 1);
    EXPECT_EQ(counts["test"], 1);
  }
  EXPECT_NE(orders.substr(0, 10), orders.substr(10, 10));
  SweepConfig other = sweep;
  other.generate->seed = 8;
  std::string other_orders;
  for (std::uint64_t i = 0; i < 200; ++i)
    other_orders += generated_dataset(*other.generate, i).split[1];
  EXPECT_NE(orders, other_orders) << "the seed shuffles";
}

TEST(Generate, AScenesOwnSplitWinsAndShardsTakeTurns) {
  const TemporaryFolder folder;
  const SweepConfig sweep =
      read_sweep(folder,
                 "generate: {count: 6, shards: 4, classes: [box, a chair], split: {train: 1}, "
                 "scenes: [{simulate: walls.yaml, split: test}, {simulate: fast.yaml}]}\n");
  const SweepPlan plan = plan_sweep(sweep, "/out");
  for (std::uint64_t i = 0; i < 6; ++i) {
    const GeneratedDataset dataset = generated_dataset(*sweep.generate, i);
    EXPECT_EQ(dataset.split, dataset.scene->name == "walls" ? "test" : "train");
    EXPECT_EQ(plan.simulations[i].output,
              "/out/data/shard-0" + std::to_string(i % 4) + "/" + plan.simulations[i].name);
    EXPECT_THAT(plan.simulations[i].commands[0],
                ::testing::Contains("scene.classes=[box, \"a chair\"]"));
  }
}

TEST(Generate, SaysWhatIsWrongAndWhere) {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& yaml) {
    return error_of([&] { return read_sweep(folder, yaml).title.empty(); });
  };
  const std::string scenes = "scenes: [{simulate: walls.yaml}]";
  EXPECT_THAT(error("generate: {count: 1, split: {train: 0}, " + scenes + "}\n"),
              HasSubstr("must not be 0 like all others"));
  EXPECT_THAT(error("generate: {count: 1, split: {trian: 1}, " + scenes + "}\n"),
              HasSubstr("did you mean 'train'?"));
  EXPECT_THAT(error("generate: {count: 1, scenes: [{simulate: walls.yaml, split: tset}]}\n"),
              HasSubstr("test"));
  EXPECT_THAT(error("generate: {count: 0, " + scenes + "}\n"),
              HasSubstr("sweep.yaml:1: generate.count"));
  EXPECT_THAT(error("generate: {count: 1, " + scenes + ", draw: {seed: 3}}\n"),
              HasSubstr("must not hold 'seed'"));
  EXPECT_THAT(error("generate: {count: 1, " + scenes + ", cases: [{name: a}, {name: a}]}\n"),
              HasSubstr("cases hold a name twice"));
  EXPECT_THAT(error("generate: {count: 1, " + scenes + "}\ndatasets: [{path: recorded}]\n"),
              HasSubstr("takes the place of 'datasets'"));
  EXPECT_THAT(error("generate: {count: 1, " + scenes + ",\n draw: {a: {uniform: [2, 1]}}}\n"),
              HasSubstr("sweep.yaml:2: generate.draw.a.uniform is empty"));
}

TEST(CalibrationRun, ScalesAMeanWithItsInterval) {
  const Estimate estimate = scaled_estimate({1, 2, 3}, 100);
  EXPECT_DOUBLE_EQ(estimate.value, 200);
  EXPECT_NEAR(estimate.spread, 100 * 4.303 / std::sqrt(3), 1e-9);
  EXPECT_EQ(scaled_estimate({1, 2, 3}, 3).spread, 0) << "nothing is left to guess";
  EXPECT_EQ(scaled_estimate({5}, 1).value, 5);
}

}  // namespace
}  // namespace saccade
