#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "simulator/record_images.h"
#include "tests/unit/simulator/scene/plane_scene.h"

namespace saccade {
namespace {

constexpr double kRowFocal_px = 100;
constexpr double kWallDepth_m = 2;
constexpr double kSlideSpeed_m_s = 4;  // 200 px/s
constexpr double kReadout_s = 0.03;
const PinholeCamera kRowCamera{64, 21, kRowFocal_px, kRowFocal_px, 31.5, 10, {}};

/// A wall before the background of radiance 0.5; its left end, radiance 1, is at x = 0.
Scene upright_edge() {
  return testing::scene_of(
      {testing::rectangle({0, -2, kWallDepth_m}, {4, 0, 0}, {0, 4, 0}, ImageF(2, 2, 1.0F))});
}

/// The camera moves along x and is at 0 at time 0.5, one second in all.
Spline slide(double speed_m_s = kSlideSpeed_m_s) {
  const std::vector<StampedPose> poses = {
      {0, {Eigen::Quaterniond::Identity(), {-0.5 * speed_m_s, 0, 0}}},
      {1, {Eigen::Quaterniond::Identity(), {0.5 * speed_m_s, 0, 0}}}};
  return Spline::interpolate(poses);
}

/// Column at which the edge stands at a time.
double edge_px(double t_s) {
  return kRowCamera.cx - kRowFocal_px * kSlideSpeed_m_s * (t_s - 0.5) / kWallDepth_m;
}

double row_s(int y, double t_s) { return t_s + (y / 20.0 - 0.5) * kReadout_s; }

TEST(RollingShutter, ShearsAMovingEdge) {
  const Scene scene = upright_edge();
  const ImageRenderer renderer(scene, kRowCamera, 1);
  const ImageF image = renderer.radiance(row_exposures(renderer, slide(), 0.5103, 0, kReadout_s));
  for (int y = 0; y < kRowCamera.height; ++y) {
    const double at_px = edge_px(row_s(y, 0.5103));
    for (int x = 0; x < kRowCamera.width; ++x)
      EXPECT_EQ(image(x, y), x < at_px ? 0.5F : 1.0F) << x << " " << y;
  }
  // 200 px/s x 30 ms.
  EXPECT_NEAR(edge_px(row_s(0, 0.5103)) - edge_px(row_s(20, 0.5103)), 6, 1e-9);
}

TEST(RollingShutter, BlursEveryRowOverItsOwnExposure) {
  constexpr double kExposure_s = 0.05;  // 10 px
  const Scene scene = upright_edge();
  const ImageRenderer renderer(scene, kRowCamera, 1);
  const ImageF image =
      renderer.radiance(row_exposures(renderer, slide(), 0.5, kExposure_s, kReadout_s));
  for (int y = 0; y < kRowCamera.height; ++y) {
    const double first_px = edge_px(row_s(y, 0.5) - 0.5 * kExposure_s);
    const double last_px = edge_px(row_s(y, 0.5) + 0.5 * kExposure_s);
    for (int x = 0; x < kRowCamera.width; ++x) {
      const double wall = std::clamp((x - last_px) / (first_px - last_px), 0.0, 1.0);
      EXPECT_NEAR(image(x, y), 0.5 + 0.5 * wall, 0.5 / 40) << x << " " << y;
    }
  }
}

TEST(RollingShutter, OfAStaticPictureIsTheGlobalOne) {
  const testing::ClosedFormPlane plane = testing::ClosedFormPlane::smooth(30, 21);
  const Scene scene = testing::scene_of(plane);
  const Spline still = slide(0);
  for (const int rays : {1, 4}) {
    const ImageRenderer renderer(scene, plane.camera, rays, TextureFilter::kMipmap);
    const ImageF global = renderer.radiance(std::vector<StampedPose>{{0.5, still.pose(0.5)}});
    const ImageF rolling = renderer.radiance(row_exposures(renderer, still, 0.5, 0, kReadout_s));
    EXPECT_TRUE(std::ranges::equal(global.pixels(), rolling.pixels()));
  }
}

TEST(RollingShutter, SeesAFlickeringLightInBands) {
  const FlickerOptions flicker{100, Waveform::kSine, 0.8, 0.5, 0};
  SceneBuilder builder;
  builder.add(testing::rectangle({-2, -2, kWallDepth_m}, {4, 0, 0}, {0, 4, 0}, ImageF(2, 2, 1.0F)),
              Eigen::Affine3d::Identity());
  builder.light(0.5, {}, flicker);
  const Scene scene = std::move(builder).build(Background(0));
  const ImageRenderer renderer(scene, kRowCamera, 1);
  for (const double exposure_s : {0.0, 0.004}) {
    const ImageF image =
        renderer.radiance(row_exposures(renderer, slide(0), 0.5, exposure_s, kReadout_s));
    for (int y = 0; y < kRowCamera.height; ++y)
      EXPECT_NEAR(image(30, y), 0.5 * Flicker(flicker).mean(row_s(y, 0.5), exposure_s), 1e-6) << y;
  }
}

TEST(RollingShutter, RowsOutsideOfTheRecordingSeeItsEnds) {
  const Scene scene = upright_edge();
  const ImageRenderer renderer(scene, kRowCamera, 1);
  const std::vector<RowExposure> rows = row_exposures(renderer, slide(), 0, 0.004, kReadout_s);
  ASSERT_EQ(rows.size(), 21U);
  for (const StampedPose& pose : rows.front().poses) EXPECT_EQ(pose.t_s, 0);
  EXPECT_EQ(rows.front().span_s, 0);
  for (const StampedPose& pose : rows.back().poses) {
    EXPECT_GT(pose.t_s, 0.013);
    EXPECT_LT(pose.t_s, 0.017);
  }
  EXPECT_NEAR(rows.back().span_s * static_cast<double>(rows.back().poses.size()), 0.004, 1e-12);
}

}  // namespace
}  // namespace saccade
