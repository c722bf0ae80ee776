#include "estimator/edges/least_squares/bundle_solver.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include <Eigen/Cholesky>

#include "core/process/parallel.h"
#include "core/random.h"
#include "estimator/edges/edge_noise.h"
#include "estimator/edges/least_squares/prior_cost.h"
#include "tests/support/synthetic_bundle.h"

namespace saccade {
namespace {

constexpr std::size_t kEdges = 150;

template <int kSupport, int kUnknowns>
using SyntheticProblem = testing::SyntheticBundle<kSupport, kUnknowns>;

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

/// Both from the same start, iteration by iteration.
template <class Problem>
void expect_the_solution_of_ceres(Problem& ours, Problem& reference) {
  // Ceres ends where the cost changes by 0, too.
  const BundleSolverOptions options{25, 1e-14};
  const SolverSummary found = solve_bundle(ours.bundle, BundleSolver::kStructured, options);
  const SolverSummary expected = solve_bundle(reference.bundle, BundleSolver::kCeres, options);
  ASSERT_TRUE(found.is_usable);
  ASSERT_TRUE(expected.is_usable);
  // Ceres says the cost of a step that it did not take, too.
  double ours_now = found.iterations.front().cost, theirs_now = expected.iterations.front().cost;
  const std::size_t both = std::min(found.iterations.size(), expected.iterations.size());
  ASSERT_GT(both, 4U);
  for (std::size_t i = 0; i < both; ++i) {
    ours_now = std::min(ours_now, found.iterations[i].cost);
    theirs_now = std::min(theirs_now, expected.iterations[i].cost);
    EXPECT_NEAR(ours_now, theirs_now, 1e-8 * theirs_now) << "iteration " << i;
  }
  EXPECT_LT(found.iterations.back().cost, 0.5 * found.iterations.front().cost);
  EXPECT_LT(largest_difference(ours.path, reference.path), 1e-8);
  for (std::size_t e = 0; e < kEdges; ++e)
    EXPECT_LT((ours.edges[e] - reference.edges[e]).norm(), 1e-6);
}

TEST(BundleSolver, OfAWindowFindsWhatCeresFinds) {
  SyntheticProblem<2, 4> ours({.twists = 9}), reference({.twists = 9});
  expect_the_solution_of_ceres(ours, reference);
}

TEST(BundleSolver, WithASurfaceFindsWhatCeresFinds) {
  SyntheticProblem<2, 4> ours({.twists = 7, .has_surface = true}),
      reference({.twists = 7, .has_surface = true});
  expect_the_solution_of_ceres(ours, reference);
  EXPECT_LT(largest_difference(ours.surface, reference.surface), 1e-8);
}

TEST(BundleSolver, OfASplineFindsWhatCeresFinds) {
  SyntheticProblem<4, 5> ours({.twists = 11, .has_surface = false, .is_robust = false}),
      reference({.twists = 11, .has_surface = false, .is_robust = false});
  expect_the_solution_of_ceres(ours, reference);
}

TEST(BundleSolver, WithRobustPriorsOfASplineFindsWhatCeresFinds) {
  SyntheticProblem<4, 5> ours({.twists = 11}), reference({.twists = 11});
  expect_the_solution_of_ceres(ours, reference);
}

TEST(BundleSolver, OfALongPathFindsWhatCeresFinds) {
  // More unknowns than are solved as a dense matrix, most of which do not couple.
  SyntheticProblem<4, 5> ours({.twists = 230, .has_surface = false, .is_robust = false}),
      reference({.twists = 230, .has_surface = false, .is_robust = false});
  expect_the_solution_of_ceres(ours, reference);
}

TEST(BundleSolver, OfEdgesSeenFromPartsOfThePathFindsWhatCeresFinds) {
  // Hardly two edges couple the same twists, and none those of its neighbour.
  const testing::SyntheticBundleOptions parts{.twists = 60, .is_robust = false, .seen = 0.3};
  SyntheticProblem<4, 5> ours(parts), reference(parts);
  expect_the_solution_of_ceres(ours, reference);
  SyntheticProblem<2, 4> ours_linear(parts), reference_linear(parts);
  expect_the_solution_of_ceres(ours_linear, reference_linear);
}

TEST(BundleSolver, IsTheSameForAnyNumberOfThreads) {
  std::vector<std::vector<double>> paths;
  for (const int threads : {1, 2, 3}) {
    set_thread_count(threads);
    // Of many chunks.
    SyntheticProblem<4, 5> problem({.twists = 60, .is_robust = false, .seen = 0.3});
    (void)solve_bundle(problem.bundle, BundleSolver::kStructured, {10, 1e-9});
    paths.push_back(problem.path);
  }
  set_thread_count(0);
  EXPECT_EQ(paths[0], paths[1]);
  EXPECT_EQ(paths[0], paths[2]);
}

/// Of the priors on the path of a SyntheticBundle.
Eigen::MatrixXd prior_information(Eigen::Index path) {
  Eigen::MatrixXd prior = Eigen::MatrixXd::Zero(path, path);
  prior.diagonal().head<6>().array() += 1e8;
  for (Eigen::Index i = 6; i < path; ++i) {
    prior(i, i) += 1e4;
    prior(i - 6, i - 6) += 1e4;
    prior(i, i - 6) -= 1e4;
    prior(i - 6, i) -= 1e4;
  }
  return prior;
}

/// The covariance of the path by the normal equations of all unknowns in one dense matrix, from the
/// scalar residual's derivatives.
Eigen::MatrixXd dense_covariance(const SyntheticProblem<4, 5>& problem) {
  const auto path = static_cast<Eigen::Index>(problem.path.size());
  const Eigen::Index all = path + 5 * static_cast<Eigen::Index>(kEdges);
  Eigen::MatrixXd square = Eigen::MatrixXd::Zero(all, all);
  for (std::size_t e = 0; e < kEdges; ++e) {
    const auto& edge = problem.bundle.edges()[e];
    const auto at = path + 5 * static_cast<Eigen::Index>(e);
    square.diagonal().segment<5>(at) += edge.prior.sigma.cwiseAbs2().cwiseInverse();
    for (std::size_t i = edge.first_lanes; i < edge.last_lanes; ++i)
      for (std::size_t lane = 0; lane < kEventLanes; ++lane) {
        if (!problem.bundle.lanes()[i].holds(lane)) continue;
        const auto event = problem.bundle.lanes()[i].event(lane, edge.pixel, edge.normal);
        Twist twist = Twist::Zero();
        for (std::size_t k = 0; k < 4; ++k)
          twist += event.weight[static_cast<Eigen::Index>(k)] *
                   Eigen::Map<const Twist>(&problem.path[6 * (event.first + k)]);
        EdgeUnknowns unknowns = problem.edges[e].head<4>();
        unknowns[1] += event.run_offset * problem.edges[e][4];
        EdgeDerivatives by;
        const double residual =
            edge_residual(event.observation, problem.bundle.camera(), twist, unknowns, &by) /
            event.sigma_px;
        Eigen::Matrix<double, 1, 29> row;
        for (Eigen::Index k = 0; k < 4; ++k) row.segment<6>(6 * k) = event.weight[k] * by.motion;
        row.tail<5>() << by.edge, event.run_offset * by.edge[1];
        row /= event.sigma_px * std::sqrt(1 + residual * residual / 4);
        std::array<Eigen::Index, 29> columns;
        for (std::size_t k = 0; k < 24; ++k)
          columns[k] = static_cast<Eigen::Index>(6 * event.first + k);
        for (std::size_t k = 0; k < 5; ++k) columns[24 + k] = at + static_cast<Eigen::Index>(k);
        for (Eigen::Index a = 0; a < 29; ++a)
          for (Eigen::Index b = 0; b < 29; ++b)
            square(columns[static_cast<std::size_t>(a)], columns[static_cast<std::size_t>(b)]) +=
                row[a] * row[b];
      }
  }
  square.topLeftCorner(path, path) += prior_information(path);
  return square.llt().solve(Eigen::MatrixXd::Identity(all, path)).topRows(path);
}

TEST(BundleSolver, CovariancesAreThoseOfTheWholeProblem) {
  SyntheticProblem<4, 5> problem({.twists = 230, .has_surface = false, .is_robust = false});
  (void)solve_bundle(problem.bundle, BundleSolver::kStructured, {10, 1e-9});
  const PathCovariances<4> covariances = path_covariances(problem.bundle);
  ASSERT_EQ(covariances.size(), 227U);
  const Eigen::MatrixXd whole = dense_covariance(problem);
  for (std::size_t i = 0; i < covariances.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(6 * i);
    const auto expected = whole.block<24, 24>(at, at);
    EXPECT_LT((covariances[i] - expected).norm(), 1e-6 * expected.norm()) << i;
  }
}

TEST(BundleSolver, WhatEdgesSayOfThePathIsWhatIsKnownBesideThePriors) {
  SyntheticProblem<4, 5> problem({.twists = 11, .has_surface = false, .is_robust = false});
  (void)solve_bundle(problem.bundle, BundleSolver::kStructured, {300, 0});
  const auto all = path_information(problem.bundle, 0, kEdges);
  ASSERT_TRUE(all);
  const Eigen::MatrixXd prior = prior_information(66);
  const Eigen::MatrixXd covariance = (all->information + prior).inverse();
  const Eigen::MatrixXd expected = dense_covariance(problem);
  EXPECT_LT((covariance - expected).norm(), 1e-6 * expected.norm());
  // From the solution edges and priors together do not lead away, but the edges alone do.
  const Eigen::VectorXd pull = prior * Eigen::Map<const Eigen::VectorXd>(problem.path.data(), 66);
  EXPECT_LT((covariance * (all->gradient + pull)).norm(), 1e-7);
  EXPECT_GT((covariance * all->gradient).norm(), 1e-5);
}

TEST(BundleSolver, WhatSomeEdgesSayAddsUp) {
  SyntheticProblem<2, 4> problem({.twists = 60, .seen = 0.3});
  const auto all = path_information(problem.bundle, 0, kEdges);
  const auto first = path_information(problem.bundle, 0, 70);
  const auto second = path_information(problem.bundle, 70, kEdges);
  ASSERT_TRUE(all && first && second);
  EXPECT_LT((first->information + second->information - all->information).norm(),
            1e-10 * all->information.norm());
  EXPECT_LT((first->gradient + second->gradient - all->gradient).norm(),
            1e-10 * all->gradient.norm());
  EXPECT_TRUE(all->information.isApprox(all->information.transpose(), 1e-12));
  EXPECT_EQ(path_information(problem.bundle, 70, 70)->information.norm(), 0);
}

/// An edge whose point leaves the view, one behind the camera and one of a single event: what
/// cannot be evaluated is left out, and the rest is solved.
TEST(BundleSolver, ToleratesEdgesThatCannotBeSeen) {
  SyntheticProblem<2, 4> problem({.twists = 9});
  std::array<Eigen::Vector4d, 3> more;
  more.fill({0.4, 0, 0, 0});
  const Eigen::Vector4d sigma = EdgeNoise::prior_sigma(0.4);
  BundleEvent<2> event;
  event.observation.ray = {0.1, 0.1, 1};
  event.observation.pixel = {120, 90};
  event.observation.normal = {1, 0};
  event.weight = {0.5, 0.5};
  const auto add = [&](std::size_t i) {
    problem.bundle.add_edge({120, 90}, {1, 0}, more[i].data(), {more[i], sigma, true});
  };
  add(0);
  event.observation.view_from_camera = Rigid3::exp((Twist() << 0, 0, 0, 3, 0, 0).finished());
  EXPECT_FALSE(problem.bundle.add_event(event));
  add(1);
  event.observation.view_from_camera = Rigid3(Eigen::Quaterniond::Identity(), {0, 0, 9});
  EXPECT_FALSE(problem.bundle.add_event(event));
  add(2);
  event.observation.view_from_camera = Rigid3();
  EXPECT_TRUE(problem.bundle.add_event(event));
  for (const BundleSolver solver : {BundleSolver::kStructured, BundleSolver::kCeres}) {
    const SolverSummary summary = solve_bundle(problem.bundle, solver, {10, 1e-9});
    EXPECT_TRUE(summary.is_usable);
    for (const Eigen::Vector4d& unknowns : more) EXPECT_TRUE(unknowns.allFinite());
  }
}

TEST(BundleSolver, AProblemThatCannotBeEvaluatedIsLeftAsItIs) {
  SyntheticProblem<2, 4> problem({.twists = 9});
  // Every camera is turned away after the events were added.
  for (std::size_t k = 0; k < 9; ++k) problem.path[6 * k + 3] = 3;
  const std::vector<double> before = problem.path;
  EXPECT_FALSE(solve_bundle(problem.bundle, BundleSolver::kStructured, {10, 1e-9}).is_usable);
  EXPECT_EQ(problem.path, before);
  EXPECT_TRUE(path_covariances(problem.bundle).empty());
}

}  // namespace
}  // namespace saccade
