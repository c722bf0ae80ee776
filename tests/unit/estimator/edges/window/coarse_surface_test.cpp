#include "estimator/edges/window/coarse_surface.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "estimator/edges/least_squares/bundle_solver.h"
#include "estimator/edges/least_squares/prior_cost.h"

namespace saccade {
namespace {

PinholeCamera camera() {
  PinholeCamera camera;
  camera.width = 100;
  camera.height = 60;
  camera.fx = camera.fy = 80;
  camera.cx = 49.5;
  camera.cy = 29.5;
  return camera;
}

/// Edges all over the view at 0.5 + 0.002 x without events, the unknowns of an adjustment.
struct Edges {
  std::vector<Eigen::Vector4d> unknowns;
  std::vector<Eigen::Vector2d> pixels;
  std::vector<double> path = std::vector<double>(12, 0);

  Edges() {
    for (int y = 3; y < 60; y += 6)
      for (int x = 2; x < 100; x += 7) {
        unknowns.emplace_back(0.5 + 0.002 * x, 0.1, 0.2, 0.3);
        pixels.emplace_back(x, y);
      }
  }

  /// Each edge's depth is certain to `prior_sigma`, relative.
  WindowBundle bundle(CoarseSurface& surface, double sigma, double prior_sigma) {
    WindowBundle bundle(camera(), path);
    surface.add_to(bundle);
    for (std::size_t i = 0; i < pixels.size(); ++i)
      bundle.add_edge(pixels[i], {1, 0}, unknowns[i].data(),
                      {unknowns[i], {prior_sigma * unknowns[i][0], 1, 1, 1}},
                      surface.link(pixels[i], sigma));
    for (const std::size_t node : {0U, 6U})
      bundle.add_factor(std::make_unique<LinearPriorCost<6>>(Matrix6::Identity(), Twist::Zero()),
                        {&path[node]});
    return bundle;
  }
};

TEST(CoarseSurface, GoesThroughTheEdges) {
  Edges edges;
  CoarseSurface surface(camera(), 30, 0.6);
  WindowBundle bundle = edges.bundle(surface, 0.02, 0.001);
  ASSERT_TRUE(solve_bundle(bundle, BundleSolver::kStructured, {30, 1e-12}).is_usable);
  // Nodes at x = 0, 24.75, ... of a plane, which bilinear nodes meet exactly.
  const std::size_t columns = 5;
  for (std::size_t i = 0; i < surface.nodes().size(); ++i)
    EXPECT_NEAR(surface.nodes()[i], 0.5 + 0.002 * 24.75 * static_cast<double>(i % columns), 2e-3);
}

TEST(CoarseSurface, BringsAnEdgeToItsNeighboursButNotOneThatIsFarOff) {
  Edges edges;
  Eigen::Vector4d &near = edges.unknowns[40], &far = edges.unknowns[70];
  const double true_inverse_depth = near[0];
  near[0] *= 1.02;
  far[0] = 5;
  CoarseSurface surface(camera(), 30, 0.6);
  WindowBundle bundle = edges.bundle(surface, 0.002, 0.02);
  ASSERT_TRUE(solve_bundle(bundle, BundleSolver::kStructured, {50, 1e-12}).is_usable);
  EXPECT_NEAR(near[0], true_inverse_depth, 3e-3 * true_inverse_depth);
  EXPECT_GT(far[0], 4);
}

TEST(CoarseSurface, CoversACameraOfOnePixel) {
  PinholeCamera small = camera();
  small.width = small.height = 1;
  CoarseSurface surface(small, 30, 0.6);
  EXPECT_EQ(surface.nodes().size(), 4U);
}

}  // namespace
}  // namespace saccade
