#pragma once

#include <algorithm>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "core/io/run/keyframe_list.h"
#include "core/time_search.h"
#include "eval/metrics/metrics.h"
#include "eval/metrics/trajectory/trajectory_metrics.h"

namespace saccade {

/// Change of the pose's error where a keyframe comes into use.
struct KeyframeJump {
  double t_s = 0;
  double position_m = 0;
  double rotation_deg = 0;
};

/// With E(t) = truth(t)^-1 estimate(t), the estimate aligned as its world is free: the translation
/// and the angle of E(before)^-1 E(after), between the last pose before a keyframe was taken and the
/// first after it. Those that no pose surrounds, such as the first, are left out.
[[nodiscard]] inline std::vector<KeyframeJump> keyframe_jumps(
    std::span<const KeyframeEntry> keyframes, const TrajectoryScoreInput& input) {
  std::vector<KeyframeJump> jumps;
  if (input.estimate.empty() || input.truth.empty()) return jumps;
  const auto poses = input.estimate.poses();
  const Similarity aligned = truth_from_estimate(input);
  const auto error = [&](const StampedPose& pose) {
    return input.truth.at_clamped(pose.t_s).inverse() * (aligned * pose.world_from_camera);
  };
  for (const KeyframeEntry& keyframe : keyframes) {
    const std::size_t after = count_until(poses, keyframe.taken_s, &StampedPose::t_s);
    if (after == 0 || after == poses.size()) continue;
    const Rigid3 jump = error(poses[after - 1]).inverse() * error(poses[after]);
    jumps.push_back(
        {keyframe.taken_s, jump.translation().norm(),
         angle_between(jump.rotation(), Eigen::Quaterniond::Identity()) * 180 / std::numbers::pi});
  }
  return jumps;
}

/// keyframes.count, keyframes.jump_percent.{mean,max} of the mean depth (null without it),
/// keyframes.jump_deg.{mean,max}.
[[nodiscard]] inline Metrics score_keyframes(std::span<const KeyframeEntry> keyframes,
                                             const TrajectoryScoreInput& input) {
  Metrics metrics;
  metrics.set("keyframes.count", static_cast<double>(keyframes.size()));
  const std::vector<KeyframeJump> jumps = keyframe_jumps(keyframes, input);
  double sum_m = 0, most_m = 0, sum_deg = 0, most_deg = 0;
  for (const KeyframeJump& jump : jumps) {
    sum_m += jump.position_m;
    most_m = std::max(most_m, jump.position_m);
    sum_deg += jump.rotation_deg;
    most_deg = std::max(most_deg, jump.rotation_deg);
  }
  const auto count = static_cast<double>(jumps.size());
  const auto set = [&](const char* key, double value, double scale) {
    metrics.set(key, jumps.empty() ? std::nullopt : std::optional(value * scale));
  };
  if (input.mean_depth_m) {
    set("keyframes.jump_percent.mean", sum_m / count, 100 / *input.mean_depth_m);
    set("keyframes.jump_percent.max", most_m, 100 / *input.mean_depth_m);
  }
  set("keyframes.jump_deg.mean", sum_deg / count, 1);
  set("keyframes.jump_deg.max", most_deg, 1);
  return metrics;
}

}  // namespace saccade
