#include "estimator/odometry/start/given_poses.h"

#include <optional>
#include <utility>
#include <vector>

#include "core/error.h"
#include "estimator/run/run_input.h"

namespace saccade {

Trajectory given_start(const RunRequest& request, const Dataset& dataset, double from_s,
                       double until_s, double offset_s) {
  if (!request.poses_from && dataset.groundtruth().empty())
    throw InputError(dataset.folder().string(),
                     "holds no groundtruth.txt, whose first poses start.truth_s asks for; give "
                     "others (--poses-from FILE) or none (start.truth_s: 0)");
  std::vector<StampedPose> start;
  std::optional<StampedPose> before;
  const Trajectory recorded = recorded_poses(request, dataset);
  for (StampedPose pose : recorded.poses()) {
    pose.t_s += offset_s;
    if (pose.t_s > until_s) break;
    if (pose.t_s < from_s)
      before = pose;
    else
      start.push_back(pose);
  }
  if (before && (start.empty() || start.front().t_s > from_s)) start.insert(start.begin(), *before);
  return smoothed_as_asked(request, Trajectory(std::move(start)));
}

}  // namespace saccade
