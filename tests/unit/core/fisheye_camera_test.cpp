#include "core/fisheye_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/error_of.h"

namespace saccade {
namespace {

/// Like the event cameras of TUM-VIE.
FisheyeCamera wide_lens() {
  FisheyeCamera camera;
  camera.width = 1280;
  camera.height = 720;
  camera.fx = 1040;
  camera.fy = 1045;
  camera.cx = 630;
  camera.cy = 340;
  camera.k = {0.02, -0.01, 0.03, -0.02};
  return camera;
}

TEST(FisheyeCamera, AnEquidistantLensKeepsAngles) {
  FisheyeCamera camera = wide_lens();
  camera.k = {};
  EXPECT_NEAR(camera.project({1, 0}).x(), camera.cx + camera.fx * std::atan(1.0), 1e-9);
  EXPECT_EQ(camera.project({0, 0}), Eigen::Vector2d(camera.cx, camera.cy));
}

TEST(FitPinhole, PutsEveryRayWhereTheFisheyeDoes) {
  const FisheyeCamera fisheye = wide_lens();
  const FisheyeFit fit = fit_pinhole(fisheye, "lens");
  EXPECT_LT(fit.residual_px, 0.1);
  for (int v = 0; v < fisheye.height; v += 40)
    for (int u = 0; u < fisheye.width; u += 40) {
      const Eigen::Vector3d ray = fit.camera.ray(fit.camera.undistort({u, v}));
      const Eigen::Vector2d expected = fisheye.project(ray.head<2>());
      EXPECT_LT((expected - Eigen::Vector2d(u, v)).norm(), fit.residual_px + 1e-6) << u << " " << v;
    }
}

TEST(FitPinhole, RefusesALensThatSeesBesideItself) {
  FisheyeCamera camera = wide_lens();
  camera.fx = camera.fy = 400;
  camera.k = {};
  EXPECT_THAT(testing::error_of([&] { return fit_pinhole(camera, "lens").residual_px; }),
              ::testing::HasSubstr("80 degrees"));
}

}  // namespace
}  // namespace saccade
