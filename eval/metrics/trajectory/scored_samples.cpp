#include "eval/metrics/trajectory/scored_samples.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace saccade {
namespace {

/// Text files round times to 1 ns; a gap of 20 ms read from one is still one of 20 ms.
constexpr double kTimeRoundingS = 2e-9;

}  // namespace

std::optional<RunRecord::Window> scored_interval(const Trajectory& truth,
                                                 const std::optional<RunRecord::Window>& window) {
  if (truth.empty()) return std::nullopt;
  RunRecord::Window result{truth.start_s(), truth.end_s()};
  if (window) {
    result.start_s = std::max(result.start_s, window->start_s);
    result.end_s = std::min(result.end_s, window->end_s);
  }
  if (result.end_s - result.start_s < 0) return std::nullopt;
  return result;
}

Rigid3 held_pose(const Trajectory& estimate, double t_s) {
  SACCADE_CHECK(!estimate.empty());
  const std::optional<std::size_t> before = estimate.last_before(t_s);
  if (!before) return estimate.poses().front().world_from_camera;
  const StampedPose& pose = estimate.poses()[*before];
  if (*before + 1 == estimate.size()) return pose.world_from_camera;
  const StampedPose& next = estimate.poses()[*before + 1];
  if (next.t_s - pose.t_s > kMaxPoseAgeS + kTimeRoundingS) return pose.world_from_camera;
  return interpolate(pose.world_from_camera, next.world_from_camera,
                     (t_s - pose.t_s) / (next.t_s - pose.t_s));
}

double coverage(const Trajectory& estimate, const RunRecord::Window& interval) {
  double covered_s = 0;
  double covered_until = interval.start_s;
  bool touched = false;
  for (const StampedPose& pose : estimate.poses()) {
    const double from = std::max(pose.t_s, covered_until);
    const double to = std::min(pose.t_s + kMaxPoseAgeS, interval.end_s);
    if (to < from) continue;
    touched = true;
    covered_s += to - from;
    covered_until = to;
  }
  if (interval.end_s <= interval.start_s) return touched ? 1 : 0;
  return std::min(1.0, covered_s / (interval.end_s - interval.start_s));
}

ScoredSamples take_samples(const Trajectory& estimate, const Trajectory& truth,
                           const RunRecord::Window& interval) {
  ScoredSamples samples;
  if (estimate.empty()) return samples;
  const auto steps = static_cast<std::size_t>(
      std::floor((interval.end_s - interval.start_s + kTimeRoundingS) / kScoreStepS));
  for (std::size_t k = 0; k <= steps; ++k) {
    const double t_s =
        std::min(interval.start_s + static_cast<double>(k) * kScoreStepS, interval.end_s);
    samples.t_s.push_back(t_s);
    samples.estimated.push_back(held_pose(estimate, t_s));
    samples.truth.push_back(truth.at_clamped(t_s));
  }
  return samples;
}

}  // namespace saccade
