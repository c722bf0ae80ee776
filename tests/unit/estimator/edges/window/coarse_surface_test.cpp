#include "estimator/edges/window/coarse_surface.h"

#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include <array>
#include <vector>

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

/// Edges all over the view at 0.5 + 0.002 x, with the unknowns of an adjustment.
struct Edges {
  std::vector<std::array<double, 4>> unknowns;
  std::vector<Eigen::Vector2d> pixels;

  Edges() {
    for (int y = 3; y < 60; y += 6)
      for (int x = 2; x < 100; x += 7) unknowns.push_back({0.5 + 0.002 * x, 0.1, 0.2, 0.3});
    for (int y = 3; y < 60; y += 6)
      for (int x = 2; x < 100; x += 7) pixels.emplace_back(x, y);
  }

  void add_to(CoarseSurface& surface, ceres::Problem& problem, double sigma) {
    surface.add_smoothness(problem);
    for (std::size_t i = 0; i < pixels.size(); ++i)
      surface.add_edge(problem, pixels[i], unknowns[i].data(), sigma);
  }
};

double cost_of(ceres::Problem& problem) {
  double cost = 0;
  problem.Evaluate({}, &cost, nullptr, nullptr, nullptr);
  return cost;
}

TEST(CoarseSurface, DerivativesAreThoseOfTheCost) {
  Edges edges;
  CoarseSurface surface(camera(), 30, 0.6);
  ceres::Problem problem;
  edges.add_to(surface, problem, 0.05);
  for (std::size_t i = 0; i < surface.nodes().size(); ++i)
    surface.nodes()[i] += 0.01 * static_cast<double>(i % 5);
  std::vector<double*> blocks;
  problem.GetParameterBlocks(&blocks);
  double cost = 0;
  std::vector<double> gradient;
  // Of its own accord Ceres takes the blocks in another order than it lists them in.
  ceres::Problem::EvaluateOptions listed;
  listed.parameter_blocks = blocks;
  problem.Evaluate(listed, &cost, nullptr, &gradient, nullptr);
  std::size_t at = 0;
  for (double* block : blocks)
    for (int k = 0; k < problem.ParameterBlockSize(block); ++k, ++at) {
      constexpr double kStep = 1e-6;
      const double value = block[k];
      block[k] = value + kStep;
      const double forward = cost_of(problem);
      block[k] = value - kStep;
      const double backward = cost_of(problem);
      block[k] = value;
      EXPECT_NEAR(gradient[at], (forward - backward) / (2 * kStep),
                  1e-5 * (1 + std::abs(gradient[at])));
    }
}

TEST(CoarseSurface, BringsAnEdgeToItsNeighboursButNotOneThatIsFarOff) {
  Edges edges;
  std::array<double, 4>& near = edges.unknowns[40];
  const double true_inverse_depth = near[0];
  std::array<double, 4>& far = edges.unknowns[70];
  near[0] *= 1.02;
  far[0] = 5;
  CoarseSurface surface(camera(), 30, 0.6);
  ceres::Problem problem;
  edges.add_to(surface, problem, 0.02);
  for (std::array<double, 4>& edge : edges.unknowns)
    if (&edge != &near) problem.SetParameterBlockConstant(edge.data());
  ceres::Solver::Options options;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  EXPECT_NEAR(near[0], true_inverse_depth, 2e-3 * true_inverse_depth);
}

TEST(CoarseSurface, CoversACameraOfOnePixel) {
  PinholeCamera small = camera();
  small.width = small.height = 1;
  CoarseSurface surface(small, 30, 0.6);
  EXPECT_EQ(surface.nodes().size(), 4U);
}

}  // namespace
}  // namespace saccade
