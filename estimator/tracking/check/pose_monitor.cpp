#include "estimator/tracking/check/pose_monitor.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/time_search.h"
#include "estimator/tracking/check/pose_probability.h"

namespace saccade {
namespace {

/// Poses are checked so often, and share the evidence in between: several times within the 50 ms in
/// which a loss should be known, and not for every pose of a fast tracker.
constexpr TimeNs kInterval_ns = 8'000'000;
constexpr TimeNs kMemory_ns = 30'000'000;
/// Fraction by which a check moves the running mean of the log odds, and their bound: the sooner a
/// change is believed, the more often by mistake.
constexpr double kBelief = 0.5;
constexpr double kMostLogOdds = 5;
/// A lost pose is found again above it: one that is neither is not reported as both in turn.
constexpr double kFoundProbability = 0.7;

/// In a gap longer than that ...
constexpr double kShortestGap_s = 0.02;
/// ... the camera is lost once it has moved by this fraction of the limits of a loss.
constexpr double kGapMotion = 0.8;

/// Motion between two poses, per second, in units of the limits of a loss.
double loss_rate(const TrackedPose& from, const TrackedPose& to, double depth_m) {
  const Twist motion = (from.world_from_camera.inverse() * to.world_from_camera).log();
  const double size = std::max(motion.head<3>().norm() / (kLossDepthRatio * depth_m),
                               motion.tail<3>().norm() / kLossAngle_rad);
  return size / seconds_from_ns(to.t_ns - from.t_ns);
}

/// The slower of the motions over two stretches before a pose: the errors of the poses look like
/// motion over a short one, and a camera that comes to rest moved in a long one.
double rate_before(std::span<const TrackedPose> poses, std::size_t last, double depth_m) {
  constexpr double kStretches_s[] = {0.015, 0.05};
  double rate = std::numeric_limits<double>::infinity();
  for (const double stretch_s : kStretches_s) {
    std::size_t from = last;
    while (from > 0 && seconds_from_ns(poses[last].t_ns - poses[from].t_ns) < stretch_s) --from;
    if (poses[from].t_ns < poses[last].t_ns)
      rate = std::min(rate, loss_rate(poses[from], poses[last], depth_m));
  }
  return std::isfinite(rate) ? rate : 0;
}

/// The probability that a camera is within the limits where it has moved by `motion` of them by
/// what was known before: one half at three quarters, as the motion may have become faster.
double probability_after(double motion) {
  constexpr double kHalf = 0.75;
  return std::exp2(-(motion / kHalf) * (motion / kHalf));
}

}  // namespace

PoseMonitor::PoseMonitor(const PinholeCamera& camera, const Recording& recording)
    : check_(recording.frames.empty() ? camera : camera.undistorted()), recording_(recording) {}

void PoseMonitor::set_map(const MapPoints& map, const Rigid3& world_from_map) {
  check_.set_map(map);
  map_from_world_ = world_from_map.inverse();
  is_map_new_ = true;
}

void PoseMonitor::measure(const TrackedPose& pose) {
  if (!recording_.frames.empty()) {
    const std::size_t until = count_until(recording_.frames, pose.t_ns, &GreyFrame::t_ns);
    if (until > 0) check_.measure(recording_.frames[until - 1].log_intensity);
    return;
  }
  // Around the time of the pose, but none after its last event.
  const std::size_t middle = count_until(recording_.events, pose.t_ns);
  const std::size_t last = count_until(recording_.events, pose.last_ns);
  const std::size_t end = std::max(middle, std::min(last, middle + check_.events() / 2));
  const std::size_t begin = end - std::min(end, check_.events());
  check_.measure(recording_.events.subspan(begin, end - begin));
}

void PoseMonitor::judge(TrackedPose& pose) {
  const bool tracker_lost = pose.status == TrackStatus::kLost;
  if (is_map_new_ || !log_odds_ || pose.t_ns >= checked_ns_ + kInterval_ns) {
    // What was known before a gap says nothing of the pose after it.
    const bool is_continued = log_odds_ && pose.t_ns < checked_ns_ + kMemory_ns;
    checked_ns_ = pose.t_ns;
    is_map_new_ = false;
    measure(pose);
    evidence_ = check_.evaluate(map_from_world_ * pose.world_from_camera);
    pose.evidence = evidence_;
    pose.evidence.tracker_lost = tracker_lost;
    const double log_odds = std::clamp(log_odds_of(pose), -kMostLogOdds, kMostLogOdds);
    log_odds_ = is_continued ? std::lerp(*log_odds_, log_odds, kBelief) : log_odds;
  }
  pose.evidence = evidence_;
  pose.evidence.tracker_lost = tracker_lost;
  pose.probability = probability_of(*log_odds_);
  is_lost_ = pose.probability < (is_lost_ ? kFoundProbability : 0.5);
  if (is_lost_)
    pose.status = TrackStatus::kLost;
  else if (pose.status == TrackStatus::kLost)
    pose.status = TrackStatus::kOk;
}

void judge_poses(const PinholeCamera& camera, const Recording& recording, const MapPoints& map,
                 const Rigid3& world_from_map, std::vector<TrackedPose>& poses) {
  PoseMonitor monitor(camera, recording);
  monitor.set_map(map, world_from_map);
  for (TrackedPose& pose : poses) monitor.judge(pose);
}

void report_gaps(TimeNs end_ns, std::vector<TrackedPose>& poses) {
  // Most recordings have no gap, and many poses: they are not copied for nothing.
  std::vector<TrackedPose> gaps;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const TimeNs next_ns = i + 1 < poses.size() ? poses[i + 1].t_ns : end_ns;
    const double gap_s = seconds_from_ns(next_ns - poses[i].t_ns);
    const double depth_m = poses[i].evidence.depth_m;
    if (poses[i].status == TrackStatus::kLost || gap_s <= kShortestGap_s || !(depth_m > 0))
      continue;
    const double rate = rate_before(poses, i, depth_m);
    const double lost_after_s = std::max(kShortestGap_s, kGapMotion / rate);
    if (!(lost_after_s < gap_s)) continue;
    TrackedPose& lost = gaps.emplace_back(poses[i]);
    lost.t_ns = lost.first_ns = lost.last_ns = poses[i].t_ns + ns_from_seconds(lost_after_s);
    lost.status = TrackStatus::kLost;
    lost.is_gap = true;
    lost.probability = std::min(lost.probability, probability_after(lost_after_s * rate));
  }
  if (gaps.empty()) return;
  poses.insert(poses.end(), gaps.begin(), gaps.end());
  std::inplace_merge(poses.begin(), poses.end() - std::ssize(gaps), poses.end(),
                     [](const TrackedPose& a, const TrackedPose& b) { return a.t_ns < b.t_ns; });
}

std::optional<double> lost_since_s(std::span<const TrackedPose> poses) {
  std::optional<double> since;
  for (std::size_t i = poses.size(); i-- > 0 && poses[i].status == TrackStatus::kLost;)
    since = seconds_from_ns(poses[i].t_ns);
  return since;
}

}  // namespace saccade
