#include "estimator/refinement/poses/path_problem.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "estimator/edges/least_squares/marginal_information.h"
#include "estimator/edges/least_squares/prior_cost.h"
#include "estimator/edges/least_squares/robust_spread.h"
#include "estimator/edges/least_squares/schur_solver.h"

namespace saccade {
PathProblem::PathProblem(const SplineControls& map_from_camera)
    : path_(map_from_camera), corrections_(map_from_camera.poses.size()) {
  for (auto& correction : corrections_) correction.fill(0);
}

std::vector<double*> PathProblem::corrections(std::size_t first, std::size_t count) {
  std::vector<double*> blocks;
  for (std::size_t k = first; k < first + count; ++k) blocks.push_back(corrections_[k].data());
  return blocks;
}

void PathProblem::add(ceres::CostFunction* cost, double outlier, std::vector<double*> blocks,
                      double sigma, double* eliminated) {
  if (eliminated != nullptr) blocks.push_back(eliminated);
  residuals_.push_back(
      {problem_.AddResidualBlock(cost, new ceres::CauchyLoss(outlier), blocks), sigma});
  if (eliminated == nullptr || ordering_->IsMember(eliminated)) return;
  ordering_->AddElementToGroup(eliminated, 0);
  eliminated_.push_back(eliminated);
}

void PathProblem::add_weak_prior(double rotation, double depth_m) {
  Twist sigma;
  sigma << Eigen::Vector3d::Constant(rotation * depth_m), Eigen::Vector3d::Constant(rotation);
  const Matrix6 root = root_of_sigma<kControlSize>(sigma);
  for (auto& correction : corrections_) {
    problem_.AddResidualBlock(new LinearPriorCost<kControlSize>(root, Twist::Zero()), nullptr,
                              correction.data());
    ordering_->AddElementToGroup(correction.data(), 1);
  }
}

void PathProblem::solve(int iterations, CostLog& costs) {
  constexpr double kTolerance = 1e-6;
  const double start_s = costs.now_s();
  const auto summary = eliminated_.empty()
                           ? solve_sparsely(problem_, iterations, kTolerance)
                           : solve_by_schur(problem_, ordering_, iterations, kTolerance);
  costs.add_round(summary.iterations, start_s);
}

SplineControls PathProblem::adjusted() const {
  SplineControls path = path_;
  for (std::size_t k = 0; k < path.poses.size(); ++k)
    path.poses[k] = corrected(path_.poses[k], corrections_[k].data());
  return path;
}

PathEvidence PathProblem::judge(double information) {
  PathEvidence evidence;
  evidence.observations = residuals_.size();
  if (residuals_.empty()) return evidence;
  std::vector<double> absolute;
  double squares = 0;
  for (const Residual& residual : residuals_) {
    double value = 0;
    problem_.EvaluateResidualBlock(residual.id, false, nullptr, &value, nullptr);
    absolute.push_back(std::abs(value) * residual.sigma);
    if (std::abs(value) < kInlier) ++evidence.inliers;
    squares += clipped_square(value);
  }
  evidence.residual = gaussian_sigma(absolute);
  evidence.covariances =
      covariances(squares / (static_cast<double>(residuals_.size()) * information));
  return evidence;
}

SplineCovariances PathProblem::covariances(double scale) {
  const Eigen::MatrixXd information =
      marginal_information(problem_, corrections(0, corrections_.size()), eliminated_);
  if (information.size() == 0) return {};
  const Eigen::LLT<Eigen::MatrixXd> factor(information);
  if (factor.info() != Eigen::Success) return {};
  return spline_covariances(
      scale * factor.solve(Eigen::MatrixXd::Identity(information.rows(), information.cols())));
}

}  // namespace saccade
