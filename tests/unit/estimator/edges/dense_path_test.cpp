#include "estimator/edges/dense_path.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace saccade {
namespace {

/// Turning by more than half a revolution, so that quaternions change their sign on the way.
Rigid3 turning(double t_s) {
  return {so3_exp({0.2 * t_s, -8 * t_s, 0.5 * t_s}), {t_s, 0.3 * t_s * t_s, -t_s}};
}

Trajectory turning_path() {
  std::vector<StampedPose> poses;
  for (int i = 0; i <= 600; ++i) poses.push_back({1e-3 * i, turning(1e-3 * i)});
  return Trajectory(std::move(poses));
}

TEST(DensePath, IsThePathInAnotherFrame) {
  const Trajectory path = turning_path();
  const Rigid3 frame_from_world = turning(0.37).inverse();
  const DensePath dense(path, 0.05, 0.55, frame_from_world);
  for (double t_s = 0.05; t_s < 0.55; t_s += 0.00137) {
    const Rigid3 expected = frame_from_world * path.at_clamped(t_s);
    const Rigid3 found = dense.at(t_s);
    EXPECT_LT(angle_between(found.rotation(), expected.rotation()), 1e-6) << t_s;
    EXPECT_LT((found.translation() - expected.translation()).norm(), 1e-6) << t_s;
  }
}

TEST(DensePath, IsHeldConstantOutsideItsStretch) {
  const Trajectory path = turning_path();
  const DensePath dense(path, 0.1, 0.2), instant(path, 0.3, 0.3);
  for (const auto& [t_s, within_s] : {std::pair(0.0, 0.1), std::pair(0.5, 0.2)})
    EXPECT_LT((dense.at(t_s).translation() - path.at_clamped(within_s).translation()).norm(),
              1e-12);
  EXPECT_LT((instant.at(0.4).translation() - path.at_clamped(0.3).translation()).norm(), 1e-12);
}

}  // namespace
}  // namespace saccade
