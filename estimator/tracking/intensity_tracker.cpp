#include "estimator/tracking/intensity_tracker.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/stopwatch.h"
#include "estimator/mean_time.h"
#include "estimator/tracking/posterior_pose.h"

namespace saccade {
namespace {

/// Fewer do not make a pose before a silence.
constexpr std::size_t kFewEvents = 100;
/// Pixels are said to be known as well at the start as after this many corrections.
constexpr float kKnownLooks = 10;
}  // namespace

/// The outcome of one alignment.
struct IntensityTracker::Estimate {
  Rigid3 map_from_camera;
  Matrix6 information = Matrix6::Zero();
  EventChunk::Sums sums;
  bool is_valid = false;
};

IntensityTracker::IntensityTracker(const IntensityOptions& options, const PredictionOptions& motion,
                                   const EventContrast& contrast, const PinholeCamera& camera,
                                   const IntensityMap& map, Tracker& edges)
    : options_(options),
      camera_(camera.undistorted()),
      world_from_map_(map.world_from_map()),
      measurements_(options, contrast, camera, map),
      motion_(motion, camera.fx),
      edges_(edges) {}

void IntensityTracker::reset(TimeNs t_ns, const Rigid3& world_from_camera) {
  motion_.reset(t_ns, world_from_map_.inverse() * world_from_camera);
  timing_ = {};
  last_event_ns_ = t_ns;
  usual_inliers_ = 0;
  misfits_ = 0;
  judged_ = {};
  attempts_ = 0;
  is_lost_ = false;
  measurements_.count_views_anew();
  restart_levels(kKnownLooks);
}

void IntensityTracker::restart_levels(float looks) {
  const ScopedTimer clock(timing_.template_s);
  measurements_.restart(motion_.pose(), looks);
}

std::vector<TrackedPose> IntensityTracker::track(std::span<const Event> events,
                                                 const std::function<void(std::size_t)>& progress) {
  Poses poses;
  const std::size_t count = events_per_pose();
  while (events.size() >= count) {
    std::size_t done = 0;
    if (is_lost_) {
      done = relocalise(events, poses);
      if (done == 0) break;  // too few events are left
    } else {
      done = before_silence(events.first(count));
      if (done == count || done >= kFewEvents) poses.push_back(track_batch(events.first(done)));
      if (done < count) lose();
    }
    if (done > 0) last_event_ns_ = events[done - 1].t_ns;
    events = events.subspan(done);
    if (progress) progress(done);
  }
  return poses;
}

std::size_t IntensityTracker::events_per_pose() const {
  if (options_.events) return static_cast<std::size_t>(*options_.events);
  constexpr double kEvents = 1000;
  constexpr double kWidth = 240;
  // Of the same motion an edge's length gives proportionally more events and its passage over more
  // pixels as many again; but more pixels also tell more of the pose.
  constexpr double kPower = 1.5;
  const double wider = std::max(1.0, camera_.width / kWidth);
  return static_cast<std::size_t>(std::lround(kEvents * std::pow(wider, kPower)));
}

std::size_t IntensityTracker::before_silence(std::span<const Event> events) const {
  // However fast the camera seems to move: a velocity from few events may be anything.
  constexpr double kShortest_s = 0.005;
  const double speed_px = motion_.speed_px(measurements_.typical_depth_m());
  TimeNs before_ns = last_event_ns_;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const double gap_s = seconds_from_ns(events[i].t_ns - before_ns);
    if (gap_s > kShortest_s && gap_s * speed_px > options_.silence_px) return i;
    before_ns = events[i].t_ns;
  }
  return events.size();
}

bool IntensityTracker::fits_worse(const EventChunk::Sums& sums, std::size_t events) {
  // Few events say little: those of several poses are judged together.
  constexpr std::size_t kEnough = 1000;
  constexpr double kUnknowns = 6;
  judged_.visible += sums.visible;
  judged_.inliers += sums.inliers;
  judged_.events += events;
  if (judged_.events < kEnough) return false;
  const Evidence evidence = std::exchange(judged_, {});
  if (evidence.visible < kUnknowns) return true;  // the map is not in view
  const double inlier_ratio = evidence.inliers / evidence.visible;
  constexpr int kPatience = 5;
  constexpr double kForget = 0.01;
  // While the levels are still uncertain fewer residuals fit.
  constexpr int kUncertain = 50;
  constexpr double kUncertainDrop = 0.6;
  if (usual_inliers_ == 0) usual_inliers_ = inlier_ratio;
  const bool is_certain = attempts_ == 0;
  const double drop = options_.inlier_drop * (is_certain ? 1 : kUncertainDrop);
  if (inlier_ratio < drop * usual_inliers_) return ++misfits_ >= kPatience;
  misfits_ = 0;
  if (is_certain) usual_inliers_ += kForget * (inlier_ratio - usual_inliers_);
  if (!is_certain && ++fits_ >= kUncertain) attempts_ = 0;
  return false;
}

void IntensityTracker::lose() {
  if (attempts_ == 0) lost_at_ = motion_.pose();
  is_lost_ = true;
  misfits_ = 0;
  judged_ = {};
}

Rigid3 IntensityTracker::guess(TimeNs t_ns) const {
  // Where it should be by now, where it was, and then around it in growing circles.
  const double gap_s = seconds_from_ns(t_ns - last_event_ns_);
  if (attempts_ == 1) return lost_at_ * Rigid3::exp(motion_.velocity() * gap_s);
  if (attempts_ == 2) return lost_at_;
  constexpr int kDirections = 8;
  constexpr double kStep_px = 6;
  const int ring = 1 + (attempts_ - 3) / kDirections;
  const double angle = 2 * std::numbers::pi * (attempts_ - 3) / kDirections;
  const double turn = kStep_px * ring / camera_.fx;
  Twist offset = Twist::Zero();
  offset.tail<3>() << turn * std::sin(angle), turn * std::cos(angle), 0;
  return lost_at_ * Rigid3::exp(offset);
}

std::size_t IntensityTracker::relocalise(std::span<const Event> events, Poses& poses) {
  constexpr std::size_t kFrames = 6;
  constexpr double kUncertain_px = 4;
  const TimeNs t_ns = events.front().t_ns;
  ++attempts_;
  edges_.reset(t_ns, world_from_map_ * guess(t_ns), kUncertain_px);
  const std::size_t done = kFrames * edges_.next_frame_events();
  if (done > events.size()) return 0;
  Poses found = edges_.track(events.first(done));
  timing_ += edges_.timing();
  double inliers = 0;
  for (TrackedPose& pose : found) {
    pose.status = TrackStatus::kLost;
    inliers += pose.inlier_ratio / static_cast<double>(found.size());
  }
  poses.insert(poses.end(), found.begin(), found.end());
  if (inliers < edges_.least_inlier_ratio()) return done;
  is_lost_ = false;
  fits_ = 0;
  motion_ = edges_.motion();
  restart_levels(1);
  return done;
}

EventChunk::Motion IntensityTracker::motion_at(const Rigid3& map_from_camera) const {
  const Rigid3 camera_from_map = map_from_camera.inverse();
  return {camera_from_map.rotation_matrix().cast<float>(),
          camera_from_map.translation().cast<float>(), motion_.velocity().cast<float>()};
}

TrackedPose IntensityTracker::track_batch(std::span<const Event> events) {
  TrackedPose pose;
  pose.first_ns = events.front().t_ns;
  pose.last_ns = events.back().t_ns;
  pose.t_ns = mean_time(events);
  const PosePrediction predicted = motion_.predict(pose.t_ns, measurements_.typical_depth_m());
  load(events, pose.t_ns, predicted.map_from_camera);
  const Estimate estimate = align(predicted);
  if (estimate.is_valid) {
    motion_.update(estimate.map_from_camera, estimate.information);
    const ScopedTimer clock(timing_.align_s);
    measurements_.correct();
  }
  pose.iterations = options_.iterations;
  pose.inlier_ratio = estimate.sums.visible > 0 ? estimate.sums.inliers / estimate.sums.visible : 0;
  if (fits_worse(estimate.sums, events.size())) {
    lose();
    pose.status = TrackStatus::kLost;
  }
  pose.residual =
      estimate.sums.weight > 0 ? std::sqrt(estimate.sums.squares / estimate.sums.weight) : 0;
  pose.world_from_camera = world_from_map_ * motion_.pose();
  pose.set_sigmas(motion_.covariance());
  return pose;
}

void IntensityTracker::load(std::span<const Event> events, TimeNs t_ns,
                            const Rigid3& map_from_camera) {
  {
    const ScopedTimer clock(timing_.template_s);
    measurements_.prepare_view(map_from_camera);
  }
  const ScopedTimer clock(timing_.event_frame_s);
  measurements_.load(events, t_ns, motion_at(map_from_camera));
}

auto IntensityTracker::align(const PosePrediction& predicted) -> Estimate {
  const ScopedTimer clock(timing_.align_s);
  PosteriorPose pose(predicted, options_.information / (options_.noise * options_.noise));
  Estimate estimate;
  for (int i = 0; i <= options_.iterations; ++i) {
    estimate.map_from_camera = pose.map_from_camera();
    estimate.sums = measurements_.evaluate(motion_at(estimate.map_from_camera));
    // The last round is for the evidence.
    if (i < options_.iterations && !pose.step(estimate.sums)) return estimate;
  }
  estimate.information = pose.information(estimate.sums);
  estimate.is_valid = true;
  return estimate;
}

}  // namespace saccade
