#include "estimator/edges/path/marginal_prior.h"

#include <gtest/gtest.h>

#include <vector>

#include <Eigen/Cholesky>

#include "core/random.h"
#include "core/rigid3.h"

namespace saccade {
namespace {

constexpr double kSpacing_s = 0.05;

/// A quadratic of so many unknowns, of less rank than that.
PathInformation random_information(Eigen::Index size, std::uint64_t seed) {
  const Random random(seed);
  Eigen::MatrixXd rows(size - 5, size);
  Eigen::VectorXd residuals(size - 5);
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    residuals[i] = random.uniform(static_cast<std::uint64_t>(i), 9999) - 0.5;
    for (Eigen::Index j = 0; j < size; ++j)
      rows(i, j) =
          random.uniform(static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(j)) - 0.5;
  }
  return {rows.transpose() * rows, rows.transpose() * residuals};
}

/// Slope and curvature of the prior's residual at these controls: J^T r and J^T J.
PathInformation at(const MarginalPrior& prior, const Eigen::VectorXd& controls) {
  const auto cost = prior.cost();
  std::vector<const double*> parameters;
  std::vector<Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>> jacobians;
  std::vector<double*> targets;
  const int rows = cost->num_residuals();
  for (std::size_t k = 0; k < prior.controls(); ++k) {
    parameters.push_back(controls.data() + 6 * k);
    jacobians.emplace_back(rows, 6);
  }
  for (auto& jacobian : jacobians) targets.push_back(jacobian.data());
  Eigen::VectorXd residuals(rows);
  EXPECT_TRUE(cost->Evaluate(parameters.data(), residuals.data(), targets.data()));
  Eigen::MatrixXd all(rows, controls.size());
  for (std::size_t k = 0; k < prior.controls(); ++k)
    all.middleCols<6>(6 * static_cast<Eigen::Index>(k)) = jacobians[k];
  return {all.transpose() * all, all.transpose() * residuals};
}

void expect_same(const PathInformation& found, const PathInformation& expected,
                 double tolerance = 1e-9) {
  ASSERT_EQ(found.gradient.size(), expected.gradient.size());
  EXPECT_LT((found.information - expected.information).norm(),
            tolerance * expected.information.norm());
  EXPECT_LT((found.gradient - expected.gradient).norm(), tolerance * expected.gradient.norm());
}

/// Of so many unknowns.
Eigen::VectorXd some_controls(Eigen::Index size) {
  return 0.01 * Eigen::VectorXd::LinSpaced(size, -1, 2);
}

TEST(MarginalPrior, KnotsOfOverlappingPathsCoincide) {
  const MarginalPrior prior(kSpacing_s);
  const SplineKnots early = prior.knots(0.12, 0.5), late = prior.knots(0.31, 0.9);
  EXPECT_DOUBLE_EQ(early.start_s, 0.1);
  EXPECT_DOUBLE_EQ(early.end_s(), 0.5);
  EXPECT_DOUBLE_EQ(late.start_s, 0.3);
  EXPECT_EQ(early.segments, 8U);
  EXPECT_LE(prior.knots(-0.01, 0.02).start_s, -0.01);
}

TEST(MarginalPrior, SaysWhatWasAdded) {
  MarginalPrior prior(kSpacing_s);
  EXPECT_TRUE(prior.empty());
  const SplineKnots knots = prior.knots(0.1, 0.4);
  const PathInformation first = random_information(48, 1), longer = random_information(54, 2);
  prior.add(knots, first);
  expect_same(at(prior, Eigen::VectorXd::Zero(48)), first);
  prior.add(prior.knots(0.1, 0.45), longer);
  PathInformation both = longer;
  both.information.topLeftCorner(48, 48) += first.information;
  both.gradient.head(48) += first.gradient;
  expect_same(at(prior, Eigen::VectorXd::Zero(54)), both);
}

TEST(MarginalPrior, AfterACorrectionTheQuadraticIsTheSame) {
  MarginalPrior prior(kSpacing_s);
  const SplineKnots knots = prior.knots(0.1, 0.4);
  prior.add(knots, random_information(48, 3));
  const PathInformation expected = at(prior, some_controls(48));
  prior.correct(knots, some_controls(48));
  expect_same(at(prior, Eigen::VectorXd::Zero(48)), expected);
}

TEST(MarginalPrior, WhatIsForgottenIsMarginalisedOut) {
  MarginalPrior prior(kSpacing_s);
  const PathInformation all = random_information(60, 4);
  prior.add(prior.knots(0.1, 0.5), all);
  const Matrix6 weak = 0.5 * Matrix6::Identity();
  prior.begin_with(prior.knots(0.2, 0.5), weak);
  ASSERT_EQ(prior.controls(), 8U);
  // The best of all unknowns, with any prior on those that are left, is the best of these.
  const Eigen::MatrixXd beside = 2 * Eigen::MatrixXd::Identity(48, 48);
  Eigen::MatrixXd whole = all.information;
  whole.topLeftCorner(12, 12).diagonal().array() += 0.5;
  whole.bottomRightCorner(48, 48) += beside;
  const Eigen::VectorXd best = -whole.ldlt().solve(all.gradient);
  const PathInformation left = at(prior, Eigen::VectorXd::Zero(48));
  const Eigen::VectorXd found = -(left.information + beside).ldlt().solve(left.gradient);
  EXPECT_LT((found - best.tail(48)).norm(), 1e-9 * best.norm());
}

TEST(MarginalPrior, OfEarlierControlsNothingIsKnown) {
  MarginalPrior prior(kSpacing_s);
  const PathInformation all = random_information(48, 8);
  prior.add(prior.knots(0.2, 0.45), all);
  prior.begin_with(prior.knots(0.1, 0.45), Matrix6::Identity());
  ASSERT_EQ(prior.controls(), 10U);
  const PathInformation found = at(prior, Eigen::VectorXd::Zero(60));
  expect_same({found.information.bottomRightCorner(48, 48), found.gradient.tail(48)}, all);
  EXPECT_EQ(found.information.topRows(12).norm(), 0);
}

TEST(MarginalPrior, OfAnotherTimeNothingIsLeft) {
  MarginalPrior prior(kSpacing_s);
  prior.add(prior.knots(0.1, 0.4), random_information(48, 5));
  prior.begin_with(prior.knots(2, 3), Matrix6::Identity());
  EXPECT_TRUE(prior.empty());
}

TEST(MarginalPrior, AGivenPoseIsWhereThePathShallBe) {
  MarginalPrior prior(kSpacing_s);
  const SplineKnots knots = prior.knots(0, 0.2);
  const Twist mean = (Twist() << 0.01, -0.02, 0.03, 0.004, -0.005, 0.006).finished();
  prior.add_pose(knots, 0.07, mean, 100 * Matrix6::Identity());
  const Eigen::VectorXd everywhere = mean.replicate(static_cast<Eigen::Index>(prior.controls()), 1);
  EXPECT_LT(at(prior, everywhere).gradient.norm(), 1e-12);
  EXPECT_GT(at(prior, Eigen::VectorXd::Zero(everywhere.size())).gradient.norm(), 1);
}

TEST(MarginalPrior, MovesWithThePath) {
  std::vector<StampedPose> before, after;
  for (double t_s = 0; t_s < 0.5; t_s += 1e-3) {
    const Rigid3 pose = Rigid3::exp((Twist() << t_s, t_s * t_s, 0, 0, 0.5 * t_s, 0).finished());
    const Twist moved = (Twist() << 0.002 * t_s, 1e-3, 0, 0, 0, -1e-3 * t_s).finished();
    before.push_back({t_s, pose});
    after.push_back({t_s, pose * Rigid3::exp(moved)});
  }
  MarginalPrior prior(kSpacing_s), same(kSpacing_s);
  const PathInformation all = random_information(60, 6);
  const SplineKnots knots = prior.knots(0.05, 0.4);
  prior.add(knots, all);
  same.add(knots, all);
  prior.move(Trajectory(before), Trajectory(after));
  // A twist that is linear in time is a spline whose controls are its values at their times.
  Eigen::VectorXd controls(60);
  for (std::size_t k = 0; k < 10; ++k) {
    const double t_s = knots.time_s(k);
    controls.segment<6>(6 * static_cast<Eigen::Index>(k)) << 0.002 * t_s, 1e-3, 0, 0, 0,
        -1e-3 * t_s;
  }
  same.correct(knots, controls);
  expect_same(at(prior, Eigen::VectorXd::Zero(60)), at(same, Eigen::VectorXd::Zero(60)), 1e-4);
}

}  // namespace
}  // namespace saccade
