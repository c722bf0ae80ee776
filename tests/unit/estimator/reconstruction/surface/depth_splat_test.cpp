#include "estimator/reconstruction/surface/depth_splat.h"

#include <gtest/gtest.h>

#include <vector>

namespace saccade {
namespace {

TEST(DepthSplat, NearPointsHideFarOnes) {
  const PinholeCamera camera{40, 30, 40, 40, 19.5, 14.5, {}};
  std::vector<Eigen::Vector3f> points;
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x) {
      const Eigen::Vector3f ray = camera.ray({x, y}).cast<float>();
      points.push_back(3.0F * ray);
      if (x >= 20) points.push_back(1.0F * ray);
    }
  ImageF inverse(40, 30);
  DepthSplat(points, 7).draw(Rigid3(), camera, inverse);
  EXPECT_NEAR(inverse(30, 15), 1, 1e-4);
  EXPECT_NEAR(inverse(5, 15), 1 / 3.0, 1e-4);
}

TEST(DepthSplat, LargerKernelsReachFarther) {
  const PinholeCamera camera{60, 60, 40, 40, 29.5, 29.5, {}};
  const std::vector<Eigen::Vector3f> point = {2.0F * camera.ray({30, 30}).cast<float>()};
  for (const int size : {3, 7, 15, 25}) {
    ImageF inverse(60, 60);
    DepthSplat(point, size).draw(Rigid3(), camera, inverse);
    int known = 0;
    for (const float value : inverse.pixels()) known += value > 0 ? 1 : 0;
    EXPECT_EQ(known, size * size);
  }
}

}  // namespace
}  // namespace saccade
