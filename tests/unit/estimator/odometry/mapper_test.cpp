#include "estimator/odometry/mapper.h"

#include <gtest/gtest.h>

#include <cstddef>

#include "tests/support/planar_world.h"

namespace saccade {
namespace {

constexpr double kMapped_s = 0.12;

/// Edges of a map of a tenth of a second, of whose depths hardly any is so certain.
std::size_t edges_with(int min_edges) {
  static const testing::PlanarWorld corner = testing::corner_world(160, 120);
  static const Events events = corner.simulate(testing::corner_glide, 0, kMapped_s, 1e-3, 0.15);
  MappingOptions options;
  options.image = false;
  options.min_edges = min_edges;
  options.depth.method = DepthConfig::Method::kRays;
  options.max_sigma = 0.01;
  options.depth.rays.refiner.max_sigma = options.depth.rays.fusion.max_sigma = 0.004;
  PathEstimate path;
  path.poses = testing::trajectory_of(testing::corner_glide, kMapped_s);
  return Mapper(options, corner.camera()).map(events, path).keyframe.edges.size();
}

TEST(Mapper, WithFewEdgesLessCertainOnesWillDo) {
  const std::size_t certain = edges_with(0);
  ASSERT_GT(certain, 10U);
  EXPECT_EQ(edges_with(static_cast<int>(certain)), certain) << "there are enough";
  const std::size_t some = edges_with(static_cast<int>(certain) + 1);
  EXPECT_GT(some, certain + certain / 4);
  EXPECT_GT(edges_with(1000000), some) << "as many as there are";
}

}  // namespace
}  // namespace saccade
