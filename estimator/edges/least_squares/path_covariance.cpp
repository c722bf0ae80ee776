#include "estimator/edges/least_squares/path_covariance.h"

namespace saccade {

SplineCovariances spline_covariances(const Eigen::MatrixXd& covariance) {
  SplineCovariances blocks;
  for (Eigen::Index first = 0; first + 24 <= covariance.rows(); first += 6)
    blocks.emplace_back(covariance.block<24, 24>(first, first));
  return blocks;
}

Matrix6 covariance_at(const SplineCovariances& covariances, std::size_t first_control,
                      const Eigen::Matrix<double, 6, 24>& by_controls) {
  if (covariances.empty()) return Matrix6::Zero();
  return by_controls * covariances[first_control] * by_controls.transpose();
}

std::vector<StampedCovariance> set_sigmas(std::span<TrackedPose> poses,
                                          const std::function<Matrix6(double t_s)>& covariance) {
  std::vector<StampedCovariance> covariances;
  for (TrackedPose& pose : poses) {
    const double t_s = seconds_from_ns(pose.t_ns);
    const Matrix6 of_pose = covariance(t_s);
    pose.set_sigmas(of_pose);
    // As in the trajectory's file, whose poses have increasing times: frames of a burst may share
    // theirs.
    if (pose.is_gap || (!covariances.empty() && t_s <= covariances.back().t_s)) continue;
    covariances.push_back({t_s, of_pose});
  }
  return covariances;
}

}  // namespace saccade
