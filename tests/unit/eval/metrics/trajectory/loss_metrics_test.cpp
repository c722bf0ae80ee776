#include "eval/metrics/trajectory/loss_metrics.h"

#include <gtest/gtest.h>

#include "eval/metrics/trajectory/reliability.h"
#include "tests/unit/eval/metrics/hand_made.h"

namespace saccade {
namespace {

using testing::joined;
using testing::straight;

/// One second; the estimate, a pose every 10 ms, is 0.11 m beside the truth from 0.2 s to 0.39 s and
/// from 0.7 s to 0.79 s, of a mean depth of 1 m: 11 %. Between the last good pose and the first bad
/// one the error grows by 1.1 % in every ms and passes 5 % in the fifth: lost are the instants
/// 195..395 ms and 695..795 ms, 201 + 101 of 1001.
TrajectoryScoreInput twice_lost() {
  Trajectory estimate = straight(0, 0.19, 0.01);
  estimate = joined(estimate, straight(0.2, 0.39, 0.01, 1, {0, 0.11, 0}));
  estimate = joined(estimate, straight(0.4, 0.69, 0.01));
  estimate = joined(estimate, straight(0.7, 0.79, 0.01, 1, {0, 0.11, 0}));
  return {.estimate = joined(estimate, straight(0.8, 1, 0.01)),
          .truth = straight(0, 1, 0.001),
          .window = {},
          .mean_depth_m = 1,
          .reported = std::vector<PoseStatus>{}};
}

constexpr double kInstant_s = 1.0 / 1001;

double loss(const Metrics& metrics, const std::string& key) {
  const std::optional<double> value = metrics.get("trajectory.loss." + key);
  EXPECT_TRUE(value) << key;
  return value.value_or(-1);
}

TEST(LossMetrics, CountWhatIsReportedOfWhatIsTrue) {
  TrajectoryScoreInput input = twice_lost();
  // The first loss is reported from 246 ms on and 10 ms beyond its end; the second is not.
  input.reported = {{0.1, false}, {0.2455, true}, {0.4045, false}};
  const Metrics m = score_loss(input);
  EXPECT_EQ(loss(m, "count"), 2);
  EXPECT_NEAR(loss(m, "recall"), (396.0 - 246) / (201 + 101), 1e-12);
  EXPECT_NEAR(loss(m, "precision"), (396.0 - 246) / (405 - 246), 1e-12);
  EXPECT_NEAR(loss(m, "unreported_s"), kInstant_s * (246 - 195 + 101), 1e-12);
  EXPECT_NEAR(loss(m, "reported_s"), kInstant_s * (405 - 246), 1e-12);
  EXPECT_NEAR(loss(m, "delay_ms"), (51.0 + 101) / 2, 1e-9);
  EXPECT_NEAR(loss(m, "first_s"), 0.195, 1e-9);
  EXPECT_NEAR(*score_trajectory(input).get("trajectory.lost_s"), kInstant_s * (201 + 101), 1e-12);
}

TEST(LossMetrics, AReportBeforeTheLossHasNoDelay) {
  TrajectoryScoreInput input = twice_lost();
  input.reported = {{0, true}};
  const Metrics m = score_loss(input);
  EXPECT_EQ(loss(m, "delay_ms"), 0);
  EXPECT_EQ(loss(m, "recall"), 1);
  EXPECT_EQ(loss(m, "unreported_s"), 0);
  EXPECT_NEAR(loss(m, "precision"), 302.0 / 1001, 1e-12);
}

TEST(LossMetrics, TheLastRowHoldsAndTheFirstIsInForceBeforeIt) {
  const std::vector<PoseStatus> rows{{0.2, true}, {0.4, false}, {0.6, true}};
  EXPECT_EQ(row_in_force(rows, 0.1), 0U);
  EXPECT_EQ(row_in_force(rows, 0.2), 0U);
  EXPECT_EQ(row_in_force(rows, 0.4), 1U);
  EXPECT_EQ(row_in_force(rows, 0.5), 1U);
  EXPECT_EQ(row_in_force(rows, 9), 2U);
  EXPECT_EQ(row_in_force({}, 0), std::nullopt);

  // A run that falls silent with a good pose reports nothing, however far the held pose is off.
  TrajectoryScoreInput input = twice_lost();
  input.estimate = straight(0, 0.5, 0.01);
  input.reported = {{0, false}, {0.5, false}};
  EXPECT_EQ(loss(score_loss(input), "recall"), 0);
  input.reported->back().is_lost = true;
  EXPECT_EQ(loss(score_loss(input), "recall"), 1);
}

TEST(LossMetrics, WhatHasNoDenominatorIsNull) {
  TrajectoryScoreInput good = twice_lost();
  good.estimate = straight(0, 1, 0.01);
  good.reported = {{0, false}};
  const Metrics m = score_loss(good);
  EXPECT_FALSE(m.get("trajectory.loss.recall"));
  EXPECT_FALSE(m.get("trajectory.loss.precision"));
  EXPECT_FALSE(m.get("trajectory.loss.delay_ms"));
  EXPECT_EQ(loss(m, "unreported_s"), 0);
  EXPECT_EQ(loss(m, "count"), 0);
  EXPECT_FALSE(m.get("trajectory.loss.first_s"));

  TrajectoryScoreInput without_report = twice_lost();
  without_report.reported.reset();
  EXPECT_FALSE(score_loss(without_report).get("trajectory.loss.count"));
  EXPECT_NEAR(loss(score_loss(without_report), "first_s"), 0.195, 1e-9)
      << "whatever the run reports";

  // Nothing reported of a true loss: no precision, but a recall of zero.
  TrajectoryScoreInput silent = twice_lost();
  silent.reported = {{0, false}};
  EXPECT_FALSE(score_loss(silent).get("trajectory.loss.precision"));
  EXPECT_EQ(loss(score_loss(silent), "recall"), 0);
  EXPECT_NEAR(loss(score_loss(silent), "delay_ms"), (201.0 + 101) / 2, 1e-9);
}

TEST(LossMetrics, AreNullWithoutStatusDepthTruthOrPose) {
  const TrajectoryScoreInput full = twice_lost();
  for (int missing = 0; missing < 4; ++missing) {
    TrajectoryScoreInput input = full;
    if (missing == 0) input.reported.reset();
    if (missing == 1) input.mean_depth_m.reset();
    if (missing == 2) input.truth = {};
    if (missing == 3) input.estimate = {};
    const Metrics m = score_loss(input);
    EXPECT_EQ(m.values().size(), 7U);
    for (const auto& [key, value] : m.values()) {
      const bool is_known = missing == 0 && key == "trajectory.loss.first_s";
      EXPECT_EQ(value.has_value(), is_known) << key << missing;
    }
  }
}

TEST(Success, IsASmallErrorWithoutALoss) {
  TrajectoryScoreInput input = twice_lost();
  EXPECT_EQ(success_of(score_trajectory(input)), 0) << "lost";
  input.estimate = straight(0, 1, 0.01, 1, {0, 0.02, 0});
  EXPECT_EQ(success_of(score_trajectory(input)), 0) << "2 % off";
  input.estimate = straight(0, 1, 0.01, 1, {0, 0.009, 0});
  EXPECT_EQ(success_of(score_trajectory(input)), 1);
  input.estimate = {};
  EXPECT_EQ(success_of(score_trajectory(input)), 0) << "no pose is no success";
  input.mean_depth_m.reset();
  EXPECT_EQ(success_of(score_trajectory(input)), std::nullopt);
}

TEST(Reliability, CountsInstantsByTheStatedProbability) {
  TrajectoryScoreInput input = twice_lost();
  // 0.95 until 0.5 s, with the first loss in it; then 0.31, with the second; 1 at the last instant.
  input.reported = {{0, false, 0.95}, {0.5, false, 0.31}, {0.9995, false, 1.0}};
  ReliabilityBins bins;
  add_reliability(input, errors_over_time(input), bins);
  EXPECT_EQ(bins[9].instants, 500 + 1);
  EXPECT_EQ(bins[9].good, 500 - 201 + 1);
  EXPECT_NEAR(bins[9].predicted, 500 * 0.95 + 1, 1e-9);
  EXPECT_EQ(bins[3].instants, 500);
  EXPECT_EQ(bins[3].good, 500 - 101);
  for (const std::size_t empty : {0, 1, 2, 4, 5, 6, 7, 8}) EXPECT_EQ(bins[empty].instants, 0);

  input.reported = {{0, false}};
  ReliabilityBins none;
  add_reliability(input, errors_over_time(input), none);
  for (const ReliabilityBin& bin : none) EXPECT_EQ(bin.instants, 0) << "no probability is stated";
}

}  // namespace
}  // namespace saccade
