#include "estimator/depth/thesis/epipolar.h"

#include <gtest/gtest.h>

#include "core/random.h"
#include "core/rigid3.h"
#include "tests/support/jacobian_check.h"

namespace saccade {
namespace {

PinholeCamera camera() {
  PinholeCamera camera;
  camera.width = 240;
  camera.height = 180;
  camera.fx = 200;
  camera.fy = 210;
  camera.cx = 118;
  camera.cy = 92;
  return camera;
}

/// A ray of the view and a centre up to half a metre away, by number.
struct Draw {
  Eigen::Vector3d ray, centre;
  double inverse_depth;

  explicit Draw(std::uint64_t i) {
    const Random random(3);
    const auto uniform = [&](std::uint64_t stream) { return random.uniform(stream, i) - 0.5; };
    ray = {uniform(0), 0.8 * uniform(1), 1};
    centre = {uniform(2), uniform(3), uniform(4)};
    inverse_depth = 0.1 + 0.8 * random.uniform(5, i);
  }
};

TEST(EpipolarLine, FollowsThePointAndItsDerivative) {
  for (std::uint64_t i = 0; i < 50; ++i) {
    const Draw d(i);
    const EpipolarLine line(camera(), d.ray, d.centre);
    ASSERT_TRUE(line.is_in_front(d.inverse_depth));
    const Eigen::Vector3d in_frame = d.ray / d.inverse_depth - d.centre;
    EXPECT_LT((line.pixel(d.inverse_depth) - camera().project(in_frame)).norm(), 1e-9);
    testing::expect_jacobian<2, 1>(
        line.derivative(d.inverse_depth),
        [&](const Eigen::Matrix<double, 1, 1>& rho) { return line.pixel(rho[0]); },
        Eigen::Matrix<double, 1, 1>(d.inverse_depth));
  }
}

TEST(EpipolarLine, IsStraight) {
  const Draw d(7);
  const EpipolarLine line(camera(), d.ray, d.centre);
  const Eigen::Vector2d start = line.pixel(0.05);
  const Eigen::Vector2d direction = (line.pixel(1.0) - start).normalized();
  for (double rho = 0.05; rho < 1; rho += 0.05) {
    const Eigen::Vector2d along = line.pixel(rho) - start;
    EXPECT_NEAR(along.x() * direction.y() - along.y() * direction.x(), 0, 1e-9);
  }
}

TEST(EpipolarLine, KnowsWhatLiesBehindTheFrame) {
  const EpipolarLine line(camera(), {0, 0, 1}, {0, 0, 2});
  EXPECT_TRUE(line.is_in_front(0.3));
  EXPECT_FALSE(line.is_in_front(0.5));
  EXPECT_FALSE(line.is_in_front(1));
}

TEST(Triangulation, RecoversTheDepth) {
  for (std::uint64_t i = 0; i < 100; ++i) {
    const Draw d(i);
    const Eigen::Vector3d in_frame = d.ray / d.inverse_depth - d.centre;
    EXPECT_NEAR(triangulate(d.ray, in_frame / in_frame.z(), d.centre), d.inverse_depth, 1e-9);
  }
}

TEST(Triangulation, RaysThatDivergeMeetBehindTheCamera) {
  const Eigen::Vector3d right(1, 0, 0);
  EXPECT_LT(triangulate({0, 0, 1}, {0.1, 0, 1}, right), 0);
}

/// A frame that is turned as well: derotated, its geometry is that of the translation alone, with
/// the centre in the reference's axes. Rotating the projection as well would rotate twice.
TEST(Triangulation, DerotatedRaysNeedNoRotation) {
  const Draw d(11);
  const Rigid3 reference_from_camera(so3_exp({0.2, -0.1, 0.3}), d.centre);
  const Eigen::Vector3d in_camera = reference_from_camera.inverse() * (d.ray / d.inverse_depth);
  const Eigen::Vector3d derotated = reference_from_camera.rotation() * in_camera;
  EXPECT_NEAR(triangulate(d.ray, derotated / derotated.z(), reference_from_camera.translation()),
              d.inverse_depth, 1e-9);
}

}  // namespace
}  // namespace saccade
