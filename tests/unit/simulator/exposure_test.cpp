#include "simulator/record_images.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/simulator/scene/plane_scene.h"

namespace saccade {
namespace {

using testing::rectangle;
using testing::scene_of;

constexpr double kFocal_px = 100;
constexpr double kDepth_m = 2;
constexpr double kSpeed_m_s = 4;  // 200 px/s
const PinholeCamera kCamera{64, 4, kFocal_px, kFocal_px, 31.5, 1.5, {}};

/// A wall in front of the background of radiance 0.5; its left end, radiance 1, is at x = 0.
Scene edge() {
  return scene_of({rectangle({0, -2, kDepth_m}, {4, 0, 0}, {0, 4, 0}, ImageF(2, 2, 1.0F))});
}

/// The camera moves along x and is at 0 at time 0.5, one second in all.
Spline transit() {
  const std::vector<StampedPose> poses = {
      {0, {Eigen::Quaterniond::Identity(), {-0.5 * kSpeed_m_s, 0, 0}}},
      {1, {Eigen::Quaterniond::Identity(), {0.5 * kSpeed_m_s, 0, 0}}}};
  return Spline::interpolate(poses);
}

ImageF blurred(const Scene& scene, const Spline& motion, double t_s, double exposure_s) {
  const ImageRenderer renderer(scene, kCamera, 1);
  std::vector<StampedPose> poses;
  for (const double t : exposure_times(renderer, motion, t_s, exposure_s))
    poses.push_back({t, motion.pose(t)});
  return renderer.radiance(poses);
}

/// Share of an exposure from `from_px` to `to_px`, where the edge is at its ends, in which pixel x
/// sees the wall to the right of the edge.
double share(int x, double from_px, double to_px) {
  return std::clamp((x - to_px) / (from_px - to_px), 0.0, 1.0);
}

TEST(Exposure, AMovingEdgeBlursOverItsPath) {
  const Scene scene = edge();
  const Spline motion = transit();
  // 0.1 s: 20 px about the principal point.
  const ImageF image = blurred(scene, motion, 0.5, 0.1);
  int ramp = 0;
  for (int x = 0; x < 64; ++x) {
    const double wall = share(x, 41.5, 21.5);
    // The exposure has 80 parts.
    EXPECT_NEAR(image(x, 1), 0.5 + 0.5 * wall, 0.5 / 80) << x;
    if (image(x, 1) > 0.501F && image(x, 1) < 0.999F) ++ramp;
  }
  EXPECT_EQ(ramp, 20);
}

TEST(Exposure, IsCutAtTheEndsOfTheRecording) {
  const Scene scene = edge();
  const Spline motion = transit().cut(0.4, 0.2);
  const ImageRenderer renderer(scene, kCamera, 1);
  for (const double t : exposure_times(renderer, motion, 0, 0.1)) {
    EXPECT_GT(t, 0);
    EXPECT_LT(t, 0.05);
  }
  // From the edge's place at the start over half of the exposure: 10 px.
  const ImageF first = blurred(scene, motion, 0, 0.1);
  const ImageF last = blurred(scene, motion, 0.2, 0.1);
  for (int x = 0; x < 64; ++x) {
    EXPECT_NEAR(first(x, 1), 0.5 + 0.5 * share(x, 51.5, 41.5), 0.5 / 40) << x;
    EXPECT_NEAR(last(x, 1), 0.5 + 0.5 * share(x, 21.5, 11.5), 0.5 / 40) << x;
  }
}

TEST(Exposure, SamplesAMotionThatTurnsRoundWithinIt) {
  std::vector<StampedPose> poses;
  for (int i = 0; i <= 100; ++i) {
    const double t = 0.01 * i;
    poses.push_back({t, {Eigen::Quaterniond::Identity(), {0.5 * std::cos(20 * (t - 0.5)), 0, 0}}});
  }
  const Scene scene = edge();
  const Spline motion = Spline::interpolate(poses);
  const ImageRenderer renderer(scene, kCamera, 1);
  // At rest at 0.5 s, 500 px/s at the ends of the exposure.
  const std::vector<double> times = exposure_times(renderer, motion, 0.5, 0.1);
  EXPECT_GT(times.size(), 150U);
  for (std::size_t i = 1; i < times.size(); ++i)
    EXPECT_LT(
        (motion.pose(times[i]).translation() - motion.pose(times[i - 1]).translation()).norm() *
            kFocal_px / kDepth_m,
        0.26);
}

TEST(Exposure, WithoutOneShowsTheInstant) {
  const Scene scene = edge();
  const Spline motion = transit();
  EXPECT_EQ(exposure_times(ImageRenderer(scene, kCamera, 1), motion, 0.3, 0),
            std::vector<double>{0.3});
}

}  // namespace
}  // namespace saccade
