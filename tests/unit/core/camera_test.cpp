#include "core/camera.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/rigid3.h"
#include "tests/support/error_of.h"
#include "tests/support/jacobian_check.h"

namespace saccade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using testing::error_of;
using testing::expect_jacobian;

PinholeCamera davis() {
  return {240, 180, 335.4, 335.3, 129.9, 99.2, {-0.1386, 0.0934, -3.4e-4, 1.7e-4, 0.02}};
}

TEST(Camera, RayTimesDepthProjectsBack) {
  const Vector2d pixel(17.25, 160.5);
  const Vector3d point = 3.5 * davis().ray(pixel);
  EXPECT_EQ(point.z(), 3.5);
  EXPECT_LT((davis().project(point) - pixel).norm(), 1e-12);
}

TEST(Camera, ProjectJacobianIsTheDerivative) {
  const PinholeCamera camera = davis();
  for (const Vector3d& point : {Vector3d(0.3, -0.2, 1.5), Vector3d(-2, 1, 4)})
    expect_jacobian(
        camera.project_jacobian(point), [&](const Vector3d& p) { return camera.project(p); },
        point);
}

TEST(Camera, InteractionMatrixIsTheDerivativeOfAPointsMotion) {
  const PinholeCamera camera = davis();
  for (const double depth : {0.5, 2.0, 20.0}) {
    const Vector3d ray = camera.ray({30, 140});
    const auto moved = [&](const Twist& twist) {
      return camera.project(Rigid3::exp(twist) * (depth * ray));
    };
    expect_jacobian(interaction_matrix(camera, ray, depth), moved, Twist::Zero().eval(), 1e-6);
  }
}

TEST(Camera, InteractionMatrixIsProjectTimesPointJacobian) {
  const PinholeCamera camera = davis();
  const Vector3d point = 1.7 * camera.ray({200, 20});
  EXPECT_LT((interaction_matrix(camera, camera.ray({200, 20}), 1.7) -
             camera.project_jacobian(point) * point_jacobian(point))
                .norm(),
            1e-10);
}

TEST(Camera, UndistortInvertsDistort) {
  const PinholeCamera camera = davis();
  for (double y = 0; y < 180; y += 29.5)
    for (double x = 0; x < 240; x += 29.75) {
      const Vector2d pixel(x, y);
      EXPECT_LT((camera.distort(camera.undistort(pixel)) - pixel).norm(), 1e-8);
      EXPECT_LT((camera.undistort(camera.distort(pixel)) - pixel).norm(), 1e-8);
    }
}

TEST(Camera, DistortionFollowsBrownsModel) {
  PinholeCamera camera{100, 100, 1, 1, 0, 0, {0.1, 0.02, 0.003, 0.004, 0.005}};
  const double x = 0.3;
  const double y = -0.2;
  const double r2 = x * x + y * y;
  const double radial = 1 + 0.1 * r2 + 0.02 * r2 * r2 + 0.005 * r2 * r2 * r2;
  const Vector2d expected(x * radial + 2 * 0.003 * x * y + 0.004 * (r2 + 2 * x * x),
                          y * radial + 0.003 * (r2 + 2 * y * y) + 2 * 0.004 * x * y);
  EXPECT_LT((camera.distort({x, y}) - expected).norm(), 1e-15);
}

TEST(Camera, WithoutDistortionPixelsStay) {
  const PinholeCamera camera = davis().undistorted();
  EXPECT_FALSE(camera.is_distorted());
  EXPECT_EQ(camera.distort({3, 4}), Vector2d(3, 4));
  EXPECT_EQ(camera.undistort({3, 4}), Vector2d(3, 4));
}

TEST(Camera, TableHoldsEveryPixel) {
  PinholeCamera camera = davis();
  camera.width = 7;
  camera.height = 5;
  const UndistortionTable table(camera);
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 7; ++x)
      EXPECT_LT((table(x, y).cast<double>() - camera.undistort({x, y})).norm(), 1e-4);
}

TEST(Camera, CheckNamesThePlace) {
  PinholeCamera camera = davis();
  EXPECT_EQ(error_of([&] { return camera.check("here"), 0; }), "no error");
  for (const int height : {0, 1}) {
    camera.height = height;
    EXPECT_NE(error_of([&] { return camera.check("here"), 0; }).find("here: camera has no area"),
              std::string::npos);
  }
  camera = davis();
  camera.fx = -1;
  EXPECT_NE(error_of([&] { return camera.check("here"), 0; }).find("fx"), std::string::npos);
  camera = davis();
  camera.distortion[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(error_of([&] { return camera.check("here"), 0; }).find("finite"), std::string::npos);
}

}  // namespace
}  // namespace saccade
