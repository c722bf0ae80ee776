#include "estimator/edges/path/marginal_prior.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>

#include "core/check.h"

namespace saccade {
namespace {

constexpr int kSamplesPerKnot = 5;  ///< of the difference of two paths

/// The square root of a quadratic with its least value left out, as a residual
///   r = W x + c,   W^T W = H,  W^T c = g,
/// by H = P^T L D L^T P. What H does not know is no row: it is positive semidefinite, and g lies in
/// its range.
class QuadraticCost : public ceres::CostFunction {
 public:
  QuadraticCost(const Eigen::MatrixXd& information, const Eigen::VectorXd& gradient) {
    const Eigen::LDLT<Eigen::MatrixXd> factor(information);
    const Eigen::VectorXd pivots = factor.vectorD();
    constexpr double kRelativeZero = 1e-12;  ///< of rounding errors
    const double zero = kRelativeZero * std::max(pivots.maxCoeff(), 0.0);
    const Eigen::VectorXd right = factor.matrixL().solve(factor.transpositionsP() * gradient);
    const Eigen::MatrixXd permuted =
        factor.transpositionsP() * Eigen::MatrixXd::Identity(gradient.size(), gradient.size());
    const Eigen::MatrixXd upper = factor.matrixU() * permuted;
    const auto rows = (pivots.array() > zero).count();
    root_.resize(rows, gradient.size());
    offset_.resize(rows);
    for (Eigen::Index i = 0, row = 0; i < pivots.size(); ++i) {
      if (!(pivots[i] > zero)) continue;
      root_.row(row) = std::sqrt(pivots[i]) * upper.row(i);
      offset_[row++] = right[i] / std::sqrt(pivots[i]);
    }
    set_num_residuals(static_cast<int>(rows));
    mutable_parameter_block_sizes()->assign(static_cast<std::size_t>(gradient.size() / 6), 6);
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    Eigen::Map<Eigen::VectorXd> result(residuals, offset_.size());
    result = offset_;
    const Eigen::Index blocks = root_.cols() / 6;
    for (Eigen::Index k = 0; k < blocks; ++k)
      result += root_.middleCols<6>(6 * k) * Eigen::Map<const Twist>(parameters[k]);
    if (jacobians == nullptr) return true;
    using Jacobian = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>;
    for (Eigen::Index k = 0; k < blocks; ++k)
      if (jacobians[k] != nullptr)
        Eigen::Map<Jacobian>(jacobians[k], root_.rows(), 6) = root_.middleCols<6>(6 * k);
    return true;
  }

 private:
  Eigen::MatrixXd root_;
  Eigen::VectorXd offset_;
};

/// The controls whose spline comes closest to Log(before(t)^-1 after(t)).
Eigen::VectorXd difference(const SplineKnots& knots, const Trajectory& before,
                           const Trajectory& after) {
  const auto controls = static_cast<Eigen::Index>(knots.controls());
  // Of what is hardly sampled, the last controls, the least.
  constexpr double kRidge = 1e-6;
  Eigen::MatrixXd square = kRidge * Eigen::MatrixXd::Identity(controls, controls);
  Eigen::Matrix<double, Eigen::Dynamic, 6> right =
      Eigen::Matrix<double, Eigen::Dynamic, 6>::Zero(controls, 6);
  const double until_s = std::min(before.end_s(), after.end_s());
  const double step_s = knots.spacing_s / kSamplesPerKnot;
  for (double t_s = std::max(knots.start_s, std::max(before.start_s(), after.start_s()));
       t_s <= std::min(knots.end_s(), until_s); t_s += step_s) {
    const SplineKnots::LocalBasis basis = knots.at(t_s);
    const Twist twist = (before.at_clamped(t_s).inverse() * after.at_clamped(t_s)).log();
    const auto first = static_cast<Eigen::Index>(basis.first);
    square.block<4, 4>(first, first) += basis.weight * basis.weight.transpose();
    right.middleRows<4>(first) += basis.weight * twist.transpose();
  }
  const Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor> twists =
      square.llt().solve(right);
  return Eigen::Map<const Eigen::VectorXd>(twists.data(), twists.size());
}

}  // namespace

SplineKnots MarginalPrior::knots(double start_s, double end_s) const {
  SACCADE_CHECK(end_s > start_s);
  const double first = std::floor(start_s / spacing_s_), last = std::ceil(end_s / spacing_s_);
  return {first * spacing_s_, spacing_s_, static_cast<std::size_t>(std::max(1.0, last - first))};
}

std::ptrdiff_t MarginalPrior::index_of(const SplineKnots& knots) const {
  return std::lround(knots.start_s / spacing_s_);
}

void MarginalPrior::reach(const SplineKnots& knots, Eigen::Index size) {
  if (empty()) first_ = index_of(knots);
  SACCADE_CHECK(index_of(knots) == first_);
  if (size <= gradient_.size()) return;
  information_.conservativeResizeLike(Eigen::MatrixXd::Zero(size, size));
  gradient_.conservativeResizeLike(Eigen::VectorXd::Zero(size));
}

void MarginalPrior::add(const SplineKnots& knots, const PathInformation& information) {
  const Eigen::Index size = information.gradient.size();
  reach(knots, size);
  information_.topLeftCorner(size, size) += information.information;
  gradient_.head(size) += information.gradient;
}

void MarginalPrior::add_pose(const SplineKnots& knots, double t_s, const Twist& mean,
                             const Matrix6& information) {
  const SplineKnots::LocalBasis basis = knots.at(t_s);
  const auto first = 6 * static_cast<Eigen::Index>(basis.first);
  reach(knots, first + 24);
  for (Eigen::Index i = 0; i < 4; ++i) {
    for (Eigen::Index j = 0; j < 4; ++j)
      information_.block<6, 6>(first + 6 * i, first + 6 * j) +=
          basis.weight[i] * basis.weight[j] * information;
    gradient_.segment<6>(first + 6 * i) -= basis.weight[i] * (information * mean);
  }
}

void MarginalPrior::begin_with(const SplineKnots& knots, const Matrix6& weak) {
  if (empty()) return;
  const Eigen::Index gone = 6 * (index_of(knots) - first_);
  first_ = index_of(knots);
  const Eigen::Index kept = gradient_.size() - gone;
  if (gone == 0) return;
  if (gone < 0) {
    Eigen::MatrixXd information = Eigen::MatrixXd::Zero(kept, kept);
    information.bottomRightCorner(gradient_.size(), gradient_.size()) = information_;
    gradient_ = (Eigen::VectorXd(kept) << Eigen::VectorXd::Zero(-gone), gradient_).finished();
    information_ = std::move(information);
    return;
  }
  if (kept < 24) {  // less than a segment
    information_.resize(0, 0);
    gradient_.resize(0);
    return;
  }
  Eigen::MatrixXd leaving = information_.topLeftCorner(gone, gone);
  for (Eigen::Index k = 0; k < gone; k += 6) leaving.block<6, 6>(k, k) += weak;
  const Eigen::LLT<Eigen::MatrixXd> factor(leaving);
  const Eigen::MatrixXd cross = information_.topRightCorner(gone, kept);
  const Eigen::MatrixXd solved = factor.solve(cross);
  const Eigen::VectorXd step = factor.solve(gradient_.head(gone));
  information_ = (information_.bottomRightCorner(kept, kept) - cross.transpose() * solved).eval();
  gradient_ = (gradient_.tail(kept) - cross.transpose() * step).eval();
}

void MarginalPrior::correct(const SplineKnots& knots, const Eigen::VectorXd& controls) {
  if (empty()) return;
  SACCADE_CHECK(index_of(knots) == first_ && controls.size() >= gradient_.size());
  gradient_ += information_ * controls.head(gradient_.size());
}

void MarginalPrior::move(const Trajectory& before, const Trajectory& after) {
  if (empty()) return;
  const SplineKnots knots{static_cast<double>(first_) * spacing_s_, spacing_s_,
                          static_cast<std::size_t>(gradient_.size() / 6 - 3)};
  correct(knots, difference(knots, before, after));
}

std::unique_ptr<ceres::CostFunction> MarginalPrior::cost() const {
  SACCADE_CHECK(!empty());
  return std::make_unique<QuadraticCost>(information_, gradient_);
}

}  // namespace saccade
