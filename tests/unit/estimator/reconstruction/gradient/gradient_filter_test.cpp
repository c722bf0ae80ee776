#include "estimator/reconstruction/gradient/gradient_filter.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/random.h"
#include "core/rigid3.h"
#include "tests/support/jacobian_check.h"

namespace saccade {
namespace {

TEST(GradientState, UpdateIsTheKalmanFilter) {
  Eigen::Vector2d g(0.1, -0.2);
  Eigen::Matrix2d p;
  p << 0.5, 0.1, 0.1, 0.3;
  const Eigen::RowVector2d h(0.7, -0.4);
  const double z = 0.2, r = 0.01;
  GradientState state{0.1F, -0.2F, 0.5F, 0.1F, 0.3F};
  state.update(0.7F, -0.4F, 0.2F, 0.01F);
  const double s = (h * p * h.transpose())(0) + r;
  const Eigen::Vector2d w = p * h.transpose() / s;
  g += w * (z - h * g);
  p -= w * s * w.transpose();
  EXPECT_NEAR(state.gx, g.x(), 1e-6);
  EXPECT_NEAR(state.gy, g.y(), 1e-6);
  EXPECT_NEAR(state.pxx, p(0, 0), 1e-6);
  EXPECT_NEAR(state.pxy, p(0, 1), 1e-6);
  EXPECT_NEAR(state.pyy, p(1, 1), 1e-6);
}

/// The displacement of the point that a pixel observes is -A^-1 du, with du the motion of the scene's
/// point in the camera and A = du_camera / du_reference, for a camera that rolls, zooms and shifts.
TEST(GradientState, ReprojectionsMoveAgainstTheScene) {
  const PinholeCamera camera{240, 180, 200, 200, 119.5, 89.5, {}};
  const double depth = 2;
  const Rigid3 camera_from_reference =
      Rigid3::exp((Twist() << 0.1, -0.05, 0.3, 0.02, -0.03, 0.5).finished());
  const Rigid3 step = Rigid3::exp((Twist() << 1e-5, 2e-5, -1e-5, 2e-5, 1e-5, 3e-5).finished());
  const auto to_camera = [&](const Rigid3& pose, const Eigen::Vector2d& u) {
    return camera.project(pose * (depth * camera.ray(u)));
  };
  const Eigen::Vector2d reference(140, 70);
  const Eigen::Vector2d before = to_camera(camera_from_reference, reference);
  const Eigen::Vector2d du = to_camera(step * camera_from_reference, reference) - before;
  const Eigen::Matrix2d a = testing::central_differences<2, 2>(
      [&](const Eigen::Vector2d& u) { return to_camera(camera_from_reference, u); }, reference,
      1e-4);
  // The point that the same pixel observes afterwards, on the same plane z = depth of the reference.
  Eigen::Vector2d reprojection = reference;
  for (int i = 0; i < 20; ++i)
    reprojection -= a.inverse() * (to_camera(step * camera_from_reference, reprojection) - before);
  const Eigen::Vector2d expected = -a.inverse() * du;
  EXPECT_LT((reprojection - reference - expected).norm(), 1e-3 * expected.norm());
}

/// Observations of a plane L = gx x + gy y, along event runs in all directions.
TEST(GradientFilter, RecoversARampWithItsSign) {
  const ReferenceGrid grid(ImageF(20, 16, 0.5F));
  const ObservationKind kind{0.02F, 0, 0};
  GradientFilter filter(grid, std::span(&kind, 1), 0.25);
  const Random random(7);
  std::uint64_t draw = 0;
  const auto uniform = [&] { return random.uniform(1, draw++); };
  std::vector<IntensityObservation> observations;
  for (std::uint32_t run = 0; run < 400; ++run) {
    const double x = 2 + 14 * uniform(), y = 2 + 10 * uniform();
    const double angle = 6.28 * uniform();
    for (int k = 0; k < 3; ++k) {
      const double u = x + 0.7 * k * std::cos(angle), v = y + 0.7 * k * std::sin(angle);
      observations.push_back({static_cast<float>(u), static_cast<float>(v),
                              static_cast<float>(0.3 * u - 0.2 * v),
                              IntensityObservation::tag(run, 0)});
    }
  }
  filter.add(observations);
  const GradientState& middle = filter.states()[8 * 20 + 10];
  EXPECT_NEAR(middle.gx, 0.3, 0.01);
  EXPECT_NEAR(middle.gy, -0.2, 0.01);
  EXPECT_LT(middle.pxx, 0.01);
  EXPECT_GT(middle.least_variance(), 0);
  // Nothing passed the corner: the prior remains.
  EXPECT_EQ(filter.states()[0].gx, 0);
  EXPECT_FLOAT_EQ(filter.states()[0].pxx, 0.25F);
}

}  // namespace
}  // namespace saccade
