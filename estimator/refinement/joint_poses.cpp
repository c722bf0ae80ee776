#include "estimator/refinement/joint_poses.h"

namespace saccade {

std::vector<StampedCovariance> take_sigmas(const JointResult& refined,
                                           std::vector<TrackedPose>& poses) {
  std::vector<StampedCovariance> covariances;
  if (refined.covariance.size() == 0) return covariances;
  for (TrackedPose& pose : poses) {
    const double t_s = seconds_from_ns(pose.t_ns);
    covariances.push_back({t_s, refined.covariance_at(t_s)});
    pose.set_sigmas(covariances.back().covariance);
  }
  return covariances;
}

}  // namespace saccade
