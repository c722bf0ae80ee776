#include "eval/gate/comparison.h"

#include <algorithm>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/error_of.h"
#include "tests/unit/eval/gate/gate_runs.h"

namespace saccade {
namespace {

using ::testing::ElementsAre;
using testing::error_of;
using testing::FakeScores;
using ::testing::HasSubstr;
using testing::quick_gate;
using testing::scale;
using Runs = std::vector<GateRun>;
using Verdict = GateRow::Verdict;

constexpr const char* kError = "trajectory.dt_rel_percent.mean";
constexpr const char* kTime = "speed.wall_s.median";

FakeScores build(std::uint64_t number, std::size_t seeds = 15) {
  FakeScores scores;
  scores.build = number;
  scores.seeds = seeds;
  return scores;
}

const GateRow* find_row(const GateResult& result, const std::string& metric,
                        Verdict verdict = Verdict::kRegressed) {
  const auto found = std::find_if(result.rows.begin(), result.rows.end(), [&](const GateRow& row) {
    return row.metric == metric && row.verdict == verdict;
  });
  return found == result.rows.end() ? nullptr : &*found;
}

/// Of `repetitions` builds with other draws, on whose runs `spoil` is let loose, how many trip.
int count_tripped(int repetitions, std::size_t seeds, const std::function<void(Runs&)>& spoil) {
  const Runs baseline = build(0, seeds).runs();
  int tripped = 0;
  for (int i = 1; i <= repetitions; ++i) {
    Runs runs = build(static_cast<std::uint64_t>(i), seeds).runs();
    spoil(runs);
    tripped += compare_runs(baseline, runs, quick_gate()).tripped() ? 1 : 0;
  }
  return tripped;
}

void spoil_nothing(Runs&) {}
void spoil_accuracy(Runs& runs) { scale(runs, kError, 1.05); }
void spoil_time(Runs& runs) {
  for (const char* key : {kTime, "speed.wall_s.min", "speed.wall_s.max"}) scale(runs, key, 1.15);
}
void spoil_sign(Runs& runs) { scale(runs, "reconstruction.fit.scale", -1, "planes"); }
/// What is not refined is as far off as the tracker, on one sequence.
void spoil_refinement(Runs& runs) { scale(runs, kError, 3, "walls"); }
/// NaN is null in metrics.json.
void spoil_number(Runs& runs) { runs[4].metrics[kError] = std::nullopt; }
void spoil_key(Runs& runs) { runs.back().metrics.erase("trajectory.lost_s"); }

TEST(Gate, LetsNeutralBuildsPass) {
  EXPECT_LE(count_tripped(50, 15, spoil_nothing), 1);
  EXPECT_LE(count_tripped(50, 3, spoil_nothing), 1);
  EXPECT_LE(count_tripped(50, 1, spoil_nothing), 1);
}

TEST(Gate, CatchesWhatGetsWorse) {
  EXPECT_GE(count_tripped(20, 15, spoil_accuracy), 19);
  EXPECT_GE(count_tripped(20, 15, spoil_time), 19);
  EXPECT_GE(count_tripped(20, 3, spoil_time), 19);
}

TEST(Gate, CatchesGrossFaultsFromOneSeedOn) {
  for (const std::size_t seeds : {1U, 3U}) {
    EXPECT_EQ(count_tripped(20, seeds, spoil_refinement), 20) << seeds << " seeds";
    EXPECT_EQ(count_tripped(20, seeds, spoil_sign), 20) << seeds << " seeds";
  }
  EXPECT_EQ(count_tripped(20, 3, spoil_number), 20);
  EXPECT_EQ(count_tripped(20, 3, spoil_key), 20);
}

TEST(Gate, SaysWhatRegressedByHowMuchAndHowSure) {
  const Runs baseline = build(0).runs();
  Runs runs = build(1).runs();
  scale(runs, kError, 1.1);
  const GateResult result = compare_runs(baseline, runs, quick_gate());
  const GateRow* row = find_row(result, kError);
  ASSERT_NE(row, nullptr);
  EXPECT_EQ(result.rows.front().metric, kError);
  EXPECT_EQ(find_row(result, "trajectory.dtheta_deg.mean"), nullptr);
  const auto pooled = std::find_if(result.rows.begin(), result.rows.end(), [](const GateRow& one) {
    return one.metric == kError && one.scope == "track, 2 sequences";
  });
  ASSERT_NE(pooled, result.rows.end());
  EXPECT_EQ(pooled->pairs, 30U);
  EXPECT_NEAR(*pooled->change, 0.1, 0.03);
  EXPECT_LT(*pooled->low, 0.1);
  EXPECT_GT(*pooled->high, 0.1);
  EXPECT_LT(*pooled->p, 0.01);
}

TEST(Gate, ReportsWhatImproved) {
  Runs runs = build(1).runs();
  scale(runs, kError, 0.8);
  const GateResult result = compare_runs(build(0).runs(), runs, quick_gate());
  EXPECT_FALSE(result.tripped());
  EXPECT_NE(find_row(result, kError, Verdict::kImproved), nullptr);
}

TEST(Gate, ASureButSmallChangeDoesNotCount) {
  const Runs baseline = build(0).runs();
  Runs runs = baseline;
  scale(runs, kError, 1.01);
  EXPECT_FALSE(compare_runs(baseline, runs, quick_gate()).tripped());
  GateOptions strict = quick_gate();
  strict.tolerance = 0.005;
  EXPECT_TRUE(compare_runs(baseline, runs, strict).tripped());
}

TEST(Gate, HigherCanBeBetter) {
  const Runs baseline = build(0).runs();
  Runs runs = baseline;
  scale(runs, "trajectory.coverage", 0.98);
  const GateResult result = compare_runs(baseline, runs, quick_gate());
  const GateRow* row = find_row(result, "trajectory.coverage");
  ASSERT_NE(row, nullptr);
  EXPECT_NEAR(*row->change, -0.02, 1e-3);
}

TEST(Gate, NullInTheBaselineAsksForNothing) {
  Runs runs = build(0).runs();
  for (GateRun& run : runs) run.metrics["trajectory.nees"] = 6;
  EXPECT_FALSE(compare_runs(build(0).runs(), runs, quick_gate()).tripped());
}

TEST(Gate, TimesOfAnotherMachineAreNotCompared) {
  Runs runs = build(0).runs();
  spoil_time(runs);
  for (GateRun& run : runs) run.machine = "another processor, Linux";
  const GateResult result = compare_runs(build(0).runs(), runs, quick_gate());
  EXPECT_FALSE(result.tripped());
  ASSERT_EQ(result.notes.size(), 1U);
  EXPECT_THAT(result.notes[0], HasSubstr("times of 30 of 30 pairs not compared"));
}

TEST(Gate, FewTimesCountOnlyWhereRepetitionsDoNotOverlap) {
  const Runs baseline = build(0, 1).runs();
  Runs runs = baseline;
  spoil_time(runs);
  EXPECT_NE(find_row(compare_runs(baseline, runs, quick_gate()), kTime), nullptr);
  for (GateRun& run : runs) run.metrics["speed.wall_s.min"] = 0.1;
  EXPECT_FALSE(compare_runs(baseline, runs, quick_gate()).tripped());
}

TEST(Gate, ARunThatIsNotThereIsNoPass) {
  const Runs baseline = build(0).runs();
  const Runs runs(baseline.begin() + 1, baseline.end());
  const GateResult result = compare_runs(baseline, runs, quick_gate());
  ASSERT_NE(find_row(result, "the run"), nullptr);
  EXPECT_EQ(find_row(result, "the run")->scope, "walls, track accurate, seed 0");
  GateOptions partial = quick_gate();
  partial.partial = true;
  EXPECT_FALSE(compare_runs(baseline, runs, partial).tripped());
}

TEST(Gate, ANewRunIsANote) {
  const Runs runs = build(0).runs();
  const Runs baseline(runs.begin() + 1, runs.end());
  const GateResult result = compare_runs(baseline, runs, quick_gate());
  EXPECT_FALSE(result.tripped());
  EXPECT_THAT(result.notes, ElementsAre("not in the baseline: walls, track accurate, seed 0"));
}

TEST(Gate, OtherDataIsANote) {
  Runs runs = build(0, 1).runs();
  runs[0].metrics["speed.events"] = 5;
  const GateResult result = compare_runs(build(0, 1).runs(), runs, quick_gate());
  EXPECT_THAT(result.notes,
              ElementsAre("walls, track accurate, seed 0: 5 events in place of 1742392; not the "
                          "same data"));
}

TEST(Gate, NothingInCommonIsAnError) {
  Runs runs = build(0).runs();
  for (GateRun& run : runs) run.key.module = "refine";
  EXPECT_THAT(error_of([&] { return compare_runs(build(0).runs(), runs, quick_gate()); }),
              HasSubstr("none of the runs is in it"));
}

TEST(Gate, FurtherMetricsAreJudgedOnDemand) {
  Runs baseline = build(0).runs();
  for (GateRun& run : baseline) run.metrics["trajectory.drift_percent"] = 0.4;
  Runs runs = baseline;
  scale(runs, "trajectory.drift_percent", 1.5);
  EXPECT_FALSE(compare_runs(baseline, runs, quick_gate()).tripped());
  GateOptions options = quick_gate();
  options.metrics = {"trajectory.drift_percent"};
  EXPECT_TRUE(compare_runs(baseline, runs, options).tripped());
  options.metrics = {"trajectory.poses"};
  EXPECT_THAT(error_of([&] { return compare_runs(baseline, runs, options); }),
              HasSubstr("neither lower nor higher is better"));
  options.metrics = {"trajectory.drift"};
  EXPECT_THAT(error_of([&] { return compare_runs(baseline, runs, options); }),
              HasSubstr("no pair of runs has a 'trajectory.drift'"));
}

TEST(GateTimes, TellASlowerBuildFromScatter) {
  const Random random(3);
  int slower = 0, false_alarms = 0;
  for (std::uint64_t i = 0; i < 50; ++i) {
    std::vector<double> first, second, third;
    for (std::uint64_t j = 0; j < 10; ++j) {
      first.push_back(std::exp(0.03 * random.normal(3 * i, j)));
      second.push_back(std::exp(0.03 * random.normal(3 * i + 1, j)));
      third.push_back(1.15 * std::exp(0.03 * random.normal(3 * i + 2, j)));
    }
    false_alarms += compare_times(first, second, quick_gate()).tripped() ? 1 : 0;
    slower += compare_times(first, third, quick_gate()).tripped() ? 1 : 0;
  }
  EXPECT_EQ(false_alarms, 0);
  EXPECT_GE(slower, 48);
}

TEST(GateTimes, SayWhereTheyCannotTell) {
  const std::vector<double> first{1, 1.5, 0.8}, second{1.6, 0.9, 1};
  const GateResult result = compare_times(first, second, quick_gate());
  EXPECT_FALSE(result.tripped());
  ASSERT_EQ(result.notes.size(), 1U);
  EXPECT_THAT(result.notes[0], HasSubstr("more --repeats"));
  const std::vector<double> steady(5, 1.0);
  EXPECT_TRUE(compare_times(steady, steady, quick_gate()).notes.empty());
}

TEST(GateOptions, AreChecked) {
  GateOptions options;
  options.slower = 1;
  EXPECT_EQ(error_of([&] { return options.check(), 0; }), "--slower: must be above 1");
}

TEST(Holm, StepsDown) {
  const std::vector<double> p{0.04, 0.01, 0.5, 0.02};
  EXPECT_THAT(holm(p), ElementsAre(0.08, 0.04, 0.5, 0.06));
}

}  // namespace
}  // namespace saccade
