#include "estimator/edges/least_squares/path_covariance.h"

namespace saccade {

Matrix6 covariance_at(const Eigen::MatrixXd& covariance, std::size_t first_control,
                      const Eigen::Matrix<double, 6, 24>& by_controls) {
  if (covariance.size() == 0) return Matrix6::Zero();
  const auto first = static_cast<Eigen::Index>(6 * first_control);
  return by_controls * covariance.block<24, 24>(first, first) * by_controls.transpose();
}

std::vector<StampedCovariance> set_sigmas(std::span<TrackedPose> poses,
                                          const std::function<Matrix6(double t_s)>& covariance) {
  std::vector<StampedCovariance> covariances;
  for (TrackedPose& pose : poses) {
    const double t_s = seconds_from_ns(pose.t_ns);
    covariances.push_back({t_s, covariance(t_s)});
    pose.set_sigmas(covariances.back().covariance);
  }
  return covariances;
}

}  // namespace saccade
