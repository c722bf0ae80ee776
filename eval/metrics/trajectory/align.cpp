#include "eval/metrics/trajectory/align.h"

#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/check.h"

namespace saccade {
namespace {

struct PairMoments {
  Eigen::Vector3d mean_estimate = Eigen::Vector3d::Zero();
  Eigen::Vector3d mean_truth = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();     ///< truth x estimate
  Eigen::Matrix3d mean_rotation = Eigen::Matrix3d::Zero();  ///< of truth_from_estimate
  double variance_estimate = 0, variance_truth = 0;
};

PairMoments moments_of(std::span<const PosePair> pairs) {
  PairMoments m;
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
    m.variance_truth += t.squaredNorm() / n;
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

/// Mean square of what the rotation, with its best scale or 1, leaves of the positions [m^2].
double left_over_m2(const PairMoments& m, const Eigen::Matrix3d& rotation, double scale) {
  const double product = (rotation.transpose() * m.covariance).trace();
  return std::max(0.0,
                  m.variance_truth - 2 * scale * product + scale * scale * m.variance_estimate);
}

double best_scale(const PairMoments& m, const Eigen::Matrix3d& rotation) {
  const double product = (rotation.transpose() * m.covariance).trace();
  return m.variance_estimate > 0 && product > 0 ? product / m.variance_estimate : 1;
}

/// `rotation`, rotated about the unit vector `axis` so that it agrees best with `wanted`:
///   tr(R(a)^T N) = cos a (tr N - u . N u) + sin a sum_ij [u]x_ij N_ij + u . N u,  N = wanted R^T.
Eigen::Matrix3d rolled(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& axis,
                       const Eigen::Matrix3d& wanted) {
  const Eigen::Matrix3d n = wanted * rotation.transpose();
  const double cosine = n.trace() - axis.dot(n * axis);
  const double sine = skew(axis).cwiseProduct(n).sum();
  return Eigen::AngleAxisd(std::atan2(sine, cosine), axis) * rotation;
}

Eigen::Matrix3d best_rotation(const PairMoments& m, Alignment alignment) {
  constexpr double kStandstill_m2 = 1e-18;
  constexpr double kRankTolerance = 1e-6;
  constexpr double kClear = 10;  // times the RMS error of the positions
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(m.covariance, Eigen::ComputeFullU);
  const Eigen::Vector3d singular = svd.singularValues();
  if (singular[0] < kStandstill_m2) return nearest_rotation(m.mean_rotation);
  const Eigen::Matrix3d rotation = nearest_rotation(m.covariance);
  const double scale = alignment == Alignment::kSim3 ? best_scale(m, rotation) : 1;
  // Both in the truth's unit: how far the path bends from its straight line, and the error.
  const double bend_m2 = scale * singular[1];
  if (bend_m2 > kClear * kClear * left_over_m2(m, rotation, scale) &&
      singular[1] > kRankTolerance * singular[0])
    return rotation;
  return rolled(rotation, svd.matrixU().col(0), m.mean_rotation);
}

/// kYaw by positions alone.
Eigen::Matrix3d yaw_by_positions(const PairMoments& m) {
  return rolled(Eigen::Matrix3d::Identity(), Eigen::Vector3d::UnitZ(), m.covariance);
}

Eigen::Matrix3d best_yaw(const PairMoments& m) {
  constexpr double kStandstill_m2 = 1e-18;
  constexpr double kClear = 10;  // times the RMS error of the positions, as in best_rotation()
  const Eigen::Matrix3d rotation = yaw_by_positions(m);
  const double horizontal_m2 = (rotation.transpose() * m.covariance).topLeftCorner<2, 2>().trace();
  if (horizontal_m2 > kStandstill_m2 &&
      horizontal_m2 > kClear * kClear * left_over_m2(m, rotation, 1))
    return rotation;
  return rolled(Eigen::Matrix3d::Identity(), Eigen::Vector3d::UnitZ(), m.mean_rotation);
}

Similarity with_rotation(const PairMoments& m, const Eigen::Matrix3d& rotation,
                         Alignment alignment) {
  Similarity result;
  if (alignment == Alignment::kSim3) result.scale = best_scale(m, rotation);
  result.rigid = {Eigen::Quaterniond(rotation),
                  m.mean_truth - result.scale * (rotation * m.mean_estimate)};
  return result;
}

}  // namespace

Alignment alignment_of(double freedoms) {
  for (const Alignment alignment : {Alignment::kYaw, Alignment::kSe3, Alignment::kSim3})
    if (freedoms == freedoms_of(alignment)) return alignment;
  return Alignment::kNone;
}

const char* alignment_text(Alignment alignment) {
  switch (alignment) {
    case Alignment::kNone:
      return "without alignment";
    case Alignment::kYaw:
      return "after an alignment of position and heading";
    case Alignment::kSe3:
      return "after an alignment by SE(3)";
    case Alignment::kSim3:
      return "after an alignment by Sim(3)";
  }
  return "";
}

std::vector<Eigen::Vector3f> operator*(const Similarity& aligned,
                                       std::span<const Eigen::Vector3f> points) {
  std::vector<Eigen::Vector3f> moved;
  moved.reserve(points.size());
  for (const Eigen::Vector3f& point : points)
    moved.emplace_back((aligned * Eigen::Vector3d(point.cast<double>())).cast<float>());
  return moved;
}

Trajectory operator*(const Similarity& aligned, const Trajectory& poses) {
  std::vector<StampedPose> moved;
  moved.reserve(poses.size());
  for (const StampedPose& pose : poses.poses())
    moved.push_back({pose.t_s, aligned * pose.world_from_camera});
  return Trajectory(std::move(moved));
}

Similarity align_positions(std::span<const PosePair> pairs, Alignment alignment) {
  if (alignment == Alignment::kNone || pairs.empty()) return {};
  const PairMoments m = moments_of(pairs);
  return with_rotation(
      m, alignment == Alignment::kYaw ? yaw_by_positions(m) : nearest_rotation(m.covariance),
      alignment);
}

Similarity align(std::span<const PosePair> pairs, Alignment alignment) {
  if (alignment == Alignment::kNone || pairs.empty()) return {};
  const PairMoments m = moments_of(pairs);
  return with_rotation(m, alignment == Alignment::kYaw ? best_yaw(m) : best_rotation(m, alignment),
                       alignment);
}

Similarity align_views(std::span<const PosePair> pairs, Alignment alignment, double depth_m) {
  SACCADE_CHECK(depth_m > 0);
  if (alignment == Alignment::kNone || pairs.empty()) return {};
  constexpr int kMostIterations = 100;
  constexpr double kConverged = 1e-12;
  const PairMoments m = moments_of(pairs);
  Eigen::Matrix3d rotation = nearest_rotation(m.mean_rotation);
  double scale = alignment == Alignment::kSim3 ? best_scale(m, rotation) : 1;
  for (int i = 0; i < kMostIterations; ++i) {
    // The squared chord of an angle a is 2 a^2 to second order: half of it is 3 - tr(R^T M).
    const Eigen::Matrix3d wanted = 2 * scale / (depth_m * depth_m) * m.covariance + m.mean_rotation;
    rotation = alignment == Alignment::kYaw
                   ? rolled(Eigen::Matrix3d::Identity(), Eigen::Vector3d::UnitZ(), wanted)
                   : nearest_rotation(wanted);
    const double before = scale;
    if (alignment == Alignment::kSim3) scale = best_scale(m, rotation);
    if (std::abs(scale - before) <= kConverged * scale) break;
  }
  return with_rotation(m, rotation, alignment);
}

}  // namespace saccade
