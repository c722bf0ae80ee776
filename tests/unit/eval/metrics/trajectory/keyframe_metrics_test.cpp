#include "eval/metrics/trajectory/keyframe_metrics.h"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

namespace saccade {
namespace {

Rigid3 at(double x_m, double turn_rad = 0) { return {so3_exp({0, 0, turn_rad}), {x_m, 0, 0}}; }

/// The truth stands still; the estimate is 1 mm off and, from 0.5 s on, 3 mm and 2 mrad.
TrajectoryScoreInput jumping() {
  TrajectoryScoreInput input;
  std::vector<StampedPose> truth, estimate;
  for (int i = 0; i <= 10; ++i) {
    const double t_s = 0.1 * i;
    truth.push_back({t_s, at(0)});
    estimate.push_back({t_s, i < 5 ? at(0.001) : at(0.003, 0.002)});
  }
  input.truth = Trajectory(truth);
  input.estimate = Trajectory(estimate);
  input.mean_depth_m = 2;
  return input;
}

std::vector<KeyframeEntry> taken_at(const std::vector<double>& times) {
  std::vector<KeyframeEntry> keyframes(times.size());
  for (std::size_t i = 0; i < times.size(); ++i) keyframes[i].t_s = keyframes[i].taken_s = times[i];
  return keyframes;
}

TEST(KeyframeMetrics, FindTheJumpWhereAKeyframeIsTaken) {
  const Metrics m = score_keyframes(taken_at({0.25, 0.45}), jumping());
  EXPECT_EQ(m.get("keyframes.count"), 2);
  EXPECT_NEAR(m.get("keyframes.jump_percent.max").value(), 0.1, 1e-9);
  EXPECT_NEAR(m.get("keyframes.jump_percent.mean").value(), 0.05, 1e-9);
  EXPECT_NEAR(m.get("keyframes.jump_deg.max").value(), 0.002 * 180 / std::numbers::pi, 1e-9);
}

TEST(KeyframeMetrics, LeaveOutKeyframesThatNoPoseSurrounds) {
  const Metrics m = score_keyframes(taken_at({-1, 2}), jumping());
  EXPECT_EQ(m.get("keyframes.count"), 2);
  EXPECT_FALSE(m.get("keyframes.jump_percent.max").has_value());
  EXPECT_FALSE(m.get("keyframes.jump_deg.mean").has_value());
}

}  // namespace
}  // namespace saccade
