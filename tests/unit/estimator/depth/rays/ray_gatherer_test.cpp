#include "estimator/depth/rays/ray_gatherer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/planar_world.h"

namespace saccade {
namespace {

using testing::corner_motion;
using testing::corner_world;
using testing::PlanarWorld;

constexpr double kView_s = 0.15;
constexpr int kSlices = 24;

class RayGather : public ::testing::Test {
 protected:
  PlanarWorld world_ = corner_world(120, 90);
  Trajectory trajectory_ = testing::trajectory_of(corner_motion, 0.3);
  Events events_ = world_.simulate(corner_motion, 0, 0.3, 1e-3, 0.15);
  UndistortionTable undistortion_{world_.camera()};
  EventRays rays_{{events_, &trajectory_, kView_s}, world_.camera(), undistortion_, kSlices};
  GatherWindow window_;

  /// Tests every ray of every slice, its polarity against the motion of its projection.
  [[nodiscard]] std::vector<std::uint32_t> by_testing_all(const SliceRange& slices,
                                                          const Edgel& edge) const {
    std::vector<std::uint32_t> found;
    for (int k = slices.first; k < slices.last; k += slices.stride)
      for (std::size_t i = rays_.slice_begin(k); i < rays_.slice_begin(k + 1); ++i) {
        const RayLine& line = rays_.line[i];
        const Eigen::Vector2f d = Eigen::Vector2f(line.ax + line.bx * edge.inverse_depth,
                                                  line.ay + line.by * edge.inverse_depth) -
                                  edge.pixel;
        const RayGradient& gradient = rays_.gradient[i];
        const Eigen::Vector2f up(gradient.qax + gradient.qbx * edge.inverse_depth,
                                 gradient.qay + gradient.qby * edge.inverse_depth);
        if (std::abs(d.dot(edge.normal)) <= static_cast<float>(window_.radius_px) &&
            std::abs(d.dot(edge.tangent())) <= static_cast<float>(window_.half_length_px) &&
            up.dot(edge.normal) > 0)
          found.push_back(static_cast<std::uint32_t>(i));
      }
    return found;
  }
};

TEST_F(RayGather, FindsWhatALookAtAllRaysFinds) {
  RayGatherer gatherer(rays_, window_);
  RayNeighbourhood near;
  std::size_t all = 0, common = 0, gathered = 0;
  for (int i = 0; i < 60; ++i) {
    const auto angle = static_cast<float>(i);
    const Edgel edge{{static_cast<float>(8 + i * 17 % 104), static_cast<float>(8 + i * 29 % 74)},
                     {std::cos(angle), std::sin(angle)},
                     0.3F + 0.01F * static_cast<float>(i % 20)};
    const SliceRange slices = i % 2 == 0 ? SliceRange{0, kSlices, 1} : SliceRange{5, 20, 2};
    gatherer.gather(slices, edge, near);
    std::vector<std::uint32_t> found(near.event.begin(),
                                     near.event.begin() + static_cast<std::ptrdiff_t>(near.count));
    std::sort(found.begin(), found.end());
    const auto expected = by_testing_all(slices, edge);
    std::vector<std::uint32_t> both;
    std::set_intersection(found.begin(), found.end(), expected.begin(), expected.end(),
                          std::back_inserter(both));
    all += expected.size();
    gathered += found.size();
    common += both.size();
  }
  ASSERT_GT(all, 1000U);
  // The polarity is that of the edge's motion, not of each ray's: edges along the motion differ.
  EXPECT_GT(common, 0.96 * static_cast<double>(all));
  EXPECT_GT(common, 0.96 * static_cast<double>(gathered));
}

TEST_F(RayGather, CoordinatesAreThoseOfTheEdge) {
  RayGatherer gatherer(rays_, window_);
  RayNeighbourhood near;
  const Edgel edge{{60, 45}, {0.6F, 0.8F}, 0.4F};
  gatherer.gather({0, kSlices, 1}, edge, near);
  ASSERT_GT(near.count, 10U);
  for (std::size_t i = 0; i < near.count; ++i) {
    const RayLine& line = rays_.line[near.event[i]];
    const Eigen::Vector2f b(line.bx, line.by);
    const Eigen::Vector2f d = Eigen::Vector2f(line.ax, line.ay) + 0.4F * b - edge.pixel;
    EXPECT_NEAR(near.across[i], d.dot(edge.normal), 1e-4);
    EXPECT_NEAR(near.along[i], d.dot(edge.tangent()), 1e-4);
    EXPECT_NEAR(near.parallax[i], b.dot(edge.normal), 1e-4);
    EXPECT_EQ(std::abs(near.polarity[i]), 1);
  }
  for (std::size_t i = near.count; i < near.padded(); ++i) EXPECT_EQ(near.polarity[i], 0);
}

TEST_F(RayGather, TheCrossingIsTheMotionAcrossTheEdge) {
  RayGatherer gatherer(rays_, window_);
  RayNeighbourhood near;
  const Edgel edge{{60, 45}, {1, 0}, 0.4F};
  gatherer.gather({0, kSlices, 1}, edge, near);
  const Eigen::Vector3d point = world_.camera().ray({60, 45}) / 0.4;
  const double length_s = static_cast<double>(rays_.slice_length_s());
  for (const int k : {0, kSlices / 2, kSlices - 1}) {
    const double t_s =
        kView_s + static_cast<double>(rays_.slices()[static_cast<std::size_t>(k)].middle_s);
    const auto seen = [&](const Eigen::Vector3d& p, double at_s) {
      return world_.camera().project(trajectory_.at_clamped(at_s).inverse() *
                                     corner_motion(kView_s) * p);
    };
    const Eigen::Vector2d motion =
        seen(point, t_s + length_s / 2) - seen(point, t_s - length_s / 2);
    const Eigen::Vector2d along = seen(world_.camera().ray({60, 46}) / 0.4, t_s) - seen(point, t_s);
    const double across = std::abs(along.y() * motion.x() - along.x() * motion.y()) / along.norm();
    EXPECT_NEAR(gatherer.slice_motion_px()[static_cast<std::size_t>(k)], across,
                0.05 * across + 0.02);
  }
}

}  // namespace
}  // namespace saccade
