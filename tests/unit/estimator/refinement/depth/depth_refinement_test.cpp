#include "estimator/refinement/depth/depth_refinement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "estimator/depth/depth_config.h"
#include "tests/support/planar_world.h"

namespace saccade {
namespace {

constexpr double kDepthEnd_s = 0.2;

struct DepthRecording {
  testing::PlanarWorld world = testing::corner_world(160, 120);
  Events events = world.simulate(testing::corner_glide, 0, kDepthEnd_s, 1e-3, 0.2);
  Trajectory path = testing::trajectory_of(testing::corner_glide, kDepthEnd_s);
  RayDepth depth{DepthConfig{}.rays, DepthConfig{}.limits, world.camera()};

  [[nodiscard]] ViewWindow window() const { return {events, &path, kDepthEnd_s / 2}; }
};

const DepthRecording& depth_recording() {
  static const DepthRecording recording;
  return recording;
}

/// Median of the relative errors, the true depth taken from the nearest pixel.
double median_error(const std::vector<EdgePoint>& points) {
  const ImageF truth = depth_recording().world.depth(testing::corner_glide(kDepthEnd_s / 2));
  std::vector<double> errors;
  for (const EdgePoint& point : points) {
    const float depth =
        truth(static_cast<int>(std::lround(point.x_px)), static_cast<int>(std::lround(point.y_px)));
    if (depth > 0)
      errors.push_back(std::abs(1 / static_cast<double>(point.inverse_depth * depth) - 1));
  }
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  return *middle;
}

RefinedDepth refined(const std::vector<EdgePoint>& start) {
  const DepthRecording& r = depth_recording();
  return refine_depth_of(r.window(), start, r.world.camera(), r.depth);
}

TEST(DepthRefinement, BringsDisturbedDepthsBack) {
  std::vector<EdgePoint> points =
      depth_recording().depth.estimate(depth_recording().window()).points;
  ASSERT_GT(points.size(), 200U);
  const double before = median_error(points);
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i].inverse_depth *= i % 2 == 0 ? 1.03F : 0.97F;
  ASSERT_GT(median_error(points), 0.02);
  const RefinedDepth result = refined(points);
  EXPECT_GT(result.edges, points.size() / 2);
  EXPECT_LT(result.cost_after, 0.9 * result.cost_before);
  EXPECT_LT(median_error(result.result.points), std::max(0.005, 1.2 * before));
  for (const EdgePoint& point : result.result.points) EXPECT_GT(point.sigma, 0);
}

TEST(DepthRefinement, WithoutPointsThereIsNothingToRefine) {
  const RefinedDepth result = refined({});
  EXPECT_EQ(result.edges, 0U);
  EXPECT_TRUE(result.result.points.empty());
}

}  // namespace
}  // namespace saccade
