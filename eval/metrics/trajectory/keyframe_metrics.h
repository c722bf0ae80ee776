#pragma once

#include <span>
#include <vector>

#include "core/io/run/keyframe_list.h"
#include "eval/metrics/metrics.h"
#include "eval/metrics/trajectory/trajectory_metrics.h"

namespace saccade {

/// Change of the pose's error where a keyframe comes into use.
struct KeyframeJump {
  double t_s = 0;
  double position_m = 0;
  double rotation_deg = 0;
};

/// With E(t) = truth(t)^-1 estimate(t): the translation and the angle of E(before)^-1 E(after),
/// between the last pose before a keyframe was taken and the first after it. Those that no pose
/// surrounds, such as the first, are left out.
[[nodiscard]] std::vector<KeyframeJump> keyframe_jumps(std::span<const KeyframeEntry> keyframes,
                                                       const TrajectoryScoreInput& input);

/// keyframes.count, keyframes.jump_percent.{mean,max} of the mean depth (null without it),
/// keyframes.jump_deg.{mean,max}.
[[nodiscard]] Metrics score_keyframes(std::span<const KeyframeEntry> keyframes,
                                      const TrajectoryScoreInput& input);

}  // namespace saccade
