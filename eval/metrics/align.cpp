#include "eval/metrics/align.h"

#include <Eigen/SVD>

namespace saccade {
namespace {

struct Moments {
  Eigen::Vector3d mean_estimate = Eigen::Vector3d::Zero();
  Eigen::Vector3d mean_truth = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();     ///< truth x estimate
  Eigen::Matrix3d mean_rotation = Eigen::Matrix3d::Zero();  ///< of truth_from_estimate
  double variance_estimate = 0;
};

Moments moments_of(std::span<const PosePair> pairs) {
  Moments m;
  const double n = static_cast<double>(pairs.size());
  for (const PosePair& pair : pairs) {
    m.mean_estimate += pair.estimated.translation() / n;
    m.mean_truth += pair.truth.translation() / n;
  }
  for (const PosePair& pair : pairs) {
    const Eigen::Vector3d e = pair.estimated.translation() - m.mean_estimate;
    const Eigen::Vector3d t = pair.truth.translation() - m.mean_truth;
    m.covariance += t * e.transpose() / n;
    m.variance_estimate += e.squaredNorm() / n;
    m.mean_rotation +=
        pair.truth.rotation_matrix() * pair.estimated.rotation_matrix().transpose() / n;
  }
  return m;
}

/// The rotation closest to `matrix`: maximises tr(R^T matrix).
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) signs.z() = -1;
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

Eigen::Matrix3d best_rotation(const Moments& m) {
  constexpr double kRankTolerance = 1e-6;
  constexpr double kStandstill_m2 = 1e-18;
  const Eigen::Vector3d singular = Eigen::JacobiSVD<Eigen::Matrix3d>(m.covariance).singularValues();
  if (singular[0] < kStandstill_m2) return nearest_rotation(m.mean_rotation);
  if (singular[1] < kRankTolerance * singular[0])
    return nearest_rotation(m.covariance + kRankTolerance * singular[0] * m.mean_rotation);
  return nearest_rotation(m.covariance);
}

}  // namespace

Similarity align(std::span<const PosePair> pairs, Alignment alignment) {
  if (alignment == Alignment::kNone || pairs.empty()) return {};
  const Moments m = moments_of(pairs);
  const Eigen::Matrix3d rotation = best_rotation(m);
  Similarity result;
  if (alignment == Alignment::kSim3 && m.variance_estimate > 0) {
    const double scale = (rotation.transpose() * m.covariance).trace() / m.variance_estimate;
    if (scale > 0) result.scale = scale;
  }
  result.rigid = {Eigen::Quaterniond(rotation),
                  m.mean_truth - result.scale * (rotation * m.mean_estimate)};
  return result;
}

}  // namespace saccade
