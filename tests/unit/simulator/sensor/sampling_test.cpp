#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/image.h"
#include "core/random.h"
#include "simulator/motion/spline_table.h"
#include "simulator/sensor/motion/image_motion.h"
#include "simulator/sensor/rays/pixel_rays.h"
#include "simulator/sensor/sample_times.h"

namespace saccade {
namespace {

TEST(SampleTimes, CountFromZeroAndIncludeTheEnd) {
  EXPECT_EQ(sample_times(4, 0.5), (std::vector<TimeNs>{0, 250'000'000, 500'000'000}));
  EXPECT_EQ(sample_times(3, 0.7), (std::vector<TimeNs>{0, 333'333'333, 666'666'667}));
  EXPECT_TRUE(sample_times(0, 1).empty());
  EXPECT_EQ(sample_times(1e-308, 1), (std::vector<TimeNs>{0}));
  EXPECT_EQ(sample_times(1e-12, 1), (std::vector<TimeNs>{0}));
}

TEST(SampleTimes, MergeLeavesOutWhatIsThereAlready) {
  EXPECT_EQ(merge_times({0, 333'333'333}, {0, 100'000'000, 333'333'334}),
            (std::vector<TimeNs>{0, 100'000'000, 333'333'333}));
  EXPECT_EQ(merge_times({}, {5}), (std::vector<TimeNs>{5}));
}

TEST(PixelRays, TilesCoverEveryPixelOnceThroughTheLens) {
  const PinholeCamera camera{10, 7, 50, 55, 4.5, 3, {-0.3, 0.1, 0.01, -0.01, 0.02}};
  const PixelRays rays(camera, 4);
  Image<int> seen(10, 7);
  for (std::size_t index = 0; index < rays.tile_count(); ++index) {
    const Tile tile = rays.tile(index);
    ASSERT_EQ(rays.rays(index).size(), 4 * tile.pixels());
    for (std::size_t i = 0; i < tile.pixels(); ++i) {
      ++seen(tile.x(i), tile.y(i));
      Eigen::Vector2d mean(0, 0);
      for (std::size_t k = 0; k < 4; ++k) {
        const Eigen::Vector2d pixel = camera.distort(camera.project(rays.rays(index)[4 * i + k]));
        const Eigen::Vector2d offset = pixel - Eigen::Vector2d(tile.x(i), tile.y(i));
        EXPECT_LT(offset.cwiseAbs().maxCoeff(), 0.5);
        mean += 0.25 * offset;
      }
      EXPECT_LT(mean.norm(), 1e-6);
    }
  }
  for (const int count : seen.pixels()) EXPECT_EQ(count, 1);
}

/// Smooth motion with strong rotation; knots every 20 ms.
Spline lively_motion() {
  std::vector<StampedPose> poses(51);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const double t = 0.02 * static_cast<double>(k);
    poses[k].t_s = t;
    poses[k].world_from_camera =
        Rigid3(so3_exp({0.4 * std::sin(9 * t), 0.3 * std::cos(7 * t), 0.5 * std::sin(11 * t)}),
               {std::sin(5 * t), 0.4 * std::cos(8 * t), 0.7 * t});
  }
  return Spline::interpolate(poses);
}

TEST(SplineTable, FollowsTheSpline) {
  const Spline motion = lively_motion();
  const SplineTable table(motion, 0.213, 0.236);
  for (int k = 0; k <= 1000; ++k) {
    const double t = 0.213 + 0.023 * k / 1000;
    const Rigid3 pose = motion.pose(t);
    const CameraFrame frame = table.at(t);
    ASSERT_LT((frame.rotation - pose.rotation_matrix()).cwiseAbs().maxCoeff(), 3e-9) << t;
    ASSERT_LT((frame.position - pose.translation()).cwiseAbs().maxCoeff(), 3e-9) << t;
  }
}

TEST(ImageMotion, BoundHoldsForEveryPointNearTheRay) {
  const PinholeCamera camera{240, 180, 200, 210, 119.5, 89.5, {}};
  const Random random(7);
  std::uint64_t draw = 0;
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * random.uniform(0, draw++);
  };
  double tightest = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    Twist twist;
    for (int k = 0; k < 6; ++k) twist[k] = uniform(-2, 2);
    const double low = uniform(0, 0.5);
    const InverseDepthRange range{low, low + uniform(0, 1)};
    const Eigen::Vector2d centre(uniform(0, 239), uniform(0, 179));
    constexpr double kRadius_px = 2.83;
    const double bound =
        image_speed_bound(camera, camera.ray(centre), kRadius_px, twist, range).fastest;
    for (int k = 0; k < 20; ++k) {
      const double angle = uniform(0, 2 * std::numbers::pi);
      const Eigen::Vector2d pixel =
          centre + kRadius_px * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      const double depth = 1 / uniform(range.low, range.high);
      const double speed = (interaction_matrix(camera, camera.ray(pixel), depth) * twist).norm();
      ASSERT_LE(speed, 1.01 * bound);
      tightest = std::max(tightest, speed / bound);
    }
  }
  EXPECT_GT(tightest, 0.9);
}

}  // namespace
}  // namespace saccade
