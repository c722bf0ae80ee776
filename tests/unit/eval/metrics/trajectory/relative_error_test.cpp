#include "eval/metrics/trajectory/relative_error.h"

#include <numbers>

#include <gtest/gtest.h>

#include "tests/unit/eval/metrics/hand_made.h"

namespace saccade {
namespace {

using testing::straight;

ScoredSamples samples_of(const Trajectory& estimate, const Trajectory& truth) {
  return take_samples(estimate, truth, {truth.start_s(), truth.end_s()});
}

TEST(RelativeError, SegmentErrorsAreThoseOfTheMean) {
  const ScoredSamples samples = samples_of(straight(0, 2, 0.01, 1.1), straight(0, 2, 0.01));
  const SegmentErrors errors = segment_errors(samples, 50);
  ASSERT_EQ(errors.trans_percent.size(), 1001U);
  for (const double percent : errors.trans_percent) EXPECT_NEAR(percent, 10, 1e-6);
  EXPECT_TRUE(segment_errors({}, 50).trans_percent.empty());
}

TEST(RelativeError, AScaleErrorIsTheSamePercentageOverEveryLength) {
  Metrics metrics;
  set_relative_errors(metrics, samples_of(straight(0, 2, 0.01, 1.1), straight(0, 2, 0.01)));
  for (const char* length : {"10", "30", "50"}) {
    const std::string key = std::string("trajectory.rpe.length_") + length + "_percent";
    EXPECT_NEAR(*metrics.get(key + ".trans_percent"), 10, 1e-6);
    EXPECT_NEAR(*metrics.get(key + ".rot_rmse_deg"), 0, 1e-9);
  }
  EXPECT_NEAR(*metrics.get("trajectory.rpe.length_10_percent.trans_rmse_m"), 0.02, 1e-9);
  EXPECT_NEAR(*metrics.get("trajectory.rpe.length_50_percent.trans_rmse_m"), 0.1, 1e-9);
  EXPECT_NEAR(*metrics.get("trajectory.rpe.per_second.trans_rmse_m"), 0.1, 1e-9);
  EXPECT_EQ(*metrics.get("trajectory.rpe.per_second.pairs"), 1001);
}

TEST(RelativeError, AConstantOffsetIsNoRelativeError) {
  Metrics metrics;
  set_relative_errors(metrics,
                      samples_of(straight(0, 2, 0.01, 1, {1, 2, 3}), straight(0, 2, 0.01)));
  EXPECT_NEAR(*metrics.get("trajectory.rpe.length_20_percent.trans_rmse_m"), 0, 1e-12);
}

TEST(RelativeError, ARotationDriftIsDegreesPerMetre) {
  std::vector<StampedPose> poses;
  for (int i = 0; i <= 100; ++i) {
    const double t_s = 0.02 * i;
    const Eigen::AngleAxisd turn(0.05 * t_s, Eigen::Vector3d::UnitX());
    poses.push_back({t_s, Rigid3(Eigen::Quaterniond(turn), {t_s, 0, 0})});
  }
  Metrics metrics;
  set_relative_errors(metrics, samples_of(Trajectory(poses), straight(0, 2, 0.01)));
  const double deg = 0.05 * 180 / std::numbers::pi;
  EXPECT_NEAR(*metrics.get("trajectory.rpe.length_10_percent.rot_deg_per_m"), deg, 1e-6);
  EXPECT_NEAR(*metrics.get("trajectory.rpe.per_second.rot_rmse_deg"), deg, 1e-6);
}

TEST(RelativeError, ShortOrStillSequencesAreNull) {
  Metrics metrics;
  set_relative_errors(metrics, samples_of(straight(0, 0.5, 0.01), straight(0, 0.5, 0.01)));
  EXPECT_EQ(metrics.get("trajectory.rpe.per_second.trans_rmse_m"), std::nullopt);
  EXPECT_EQ(metrics.get("trajectory.rpe.per_second.pairs"), 0);
  EXPECT_TRUE(metrics.get("trajectory.rpe.length_50_percent.trans_rmse_m"));

  const ScoredSamples still = samples_of(straight(0, 2, 0.01, 1), straight(0, 2, 0.01, 0));
  set_relative_errors(metrics, still);
  EXPECT_EQ(metrics.get("trajectory.rpe.length_50_percent.trans_rmse_m"), std::nullopt);
  EXPECT_EQ(drift_percent(still), std::nullopt);
  EXPECT_EQ(drift_percent({}), std::nullopt);
}

TEST(Drift, IsTheEndErrorOverThePath) {
  const Trajectory truth = straight(0, 2, 0.01);
  EXPECT_NEAR(*drift_percent(samples_of(straight(0, 2, 0.01, 0.97), truth)), 3, 1e-9);
  // Starting elsewhere is no drift.
  EXPECT_NEAR(*drift_percent(samples_of(straight(0, 2, 0.01, 1, {0, 5, 0}), truth)), 0, 1e-9);
}

}  // namespace
}  // namespace saccade
