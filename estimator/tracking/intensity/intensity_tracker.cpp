#include "estimator/tracking/intensity/intensity_tracker.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/stopwatch.h"
#include "core/time_search.h"
#include "estimator/mean_time.h"
#include "estimator/tracking/pose_solver.h"

namespace saccade {
namespace {

/// Fewer do not make a pose before a gap in the events.
constexpr std::size_t kMinEventsBeforeGap = 100;
/// Standard deviations of the pixels read from the map: at the start, and where the camera is found again [log units].
constexpr float kKnownSigma = 0.02F;
constexpr float kFoundSigma = 0.3F;
/// Gauss-Newton steps of a pose, always all of them: from the prediction they suffice.
constexpr int kIterations = 4;
/// Neighbouring residuals err alike: their information counts by this fraction.
constexpr double kInformation = 0.1;
/// Lost below this fraction of the mean inlier ratio, ...
constexpr double kInlierDrop = 0.75;
/// ... and where the camera should have moved so far without an event.
constexpr double kMaxMotionWithoutEvents_px = 2;

}  // namespace

void describe(config::Fields& fields, IntensityOptions& options) {
  fields
      .value("events", options.events,
             "Events per pose; ~ takes as many as come from 500 pixels, times (width / 240 px)^1.5 "
             "on a wider sensor, or from up to 15000 while the image moves by 0.4 px. More of "
             "them cost less time per second of recording and follow the motion more coarsely.")
      .range(1, 1e6);
  fields
      .value("no_event_ratio", options.no_event_ratio,
             "No-event constraints per pixel with events: pixels between their events, which are "
             "within a threshold of their last value. 0 disables them.")
      .range(0, 1000);
  fields
      .value(
          "mismatch_sigma", options.mismatch_sigma,
          "Standard deviation of a pixel's threshold, relative to it. ~ takes 0.02 where pixels "
          "fire several times at once, as only ideal ones do, and else 0.15. A larger one trusts "
          "the map more and the pixels less.")
      .range(0, 1);
  fields
      .value(
          "map_blur_px", options.map_blur_px,
          "Standard deviation in pixels of the Gaussian that smooths the map at its strong edges; "
          "0 disables it.")
      .range(0, 10);
}

IntensityTracker::IntensityTracker(const IntensityOptions& options,
                                   const MotionModelOptions& motion,
                                   const std::optional<EventContrast>& contrast,
                                   const PinholeCamera& camera, const IntensityMap& map,
                                   EdgeTracker edges)
    : Tracker(motion, camera.fx, map.world_from_map()),
      options_(options),
      camera_(camera.undistorted()),
      knows_contrast_(contrast.has_value()),
      residuals_(options, camera, map),
      fallback_(std::move(edges)),
      last_batch_(static_cast<std::size_t>(camera.width) *
                  static_cast<std::size_t>(camera.height)) {
  if (contrast) residuals_.set_contrast(*contrast);
}

void IntensityTracker::reset(TimeNs t_ns, const Rigid3& world_from_camera) {
  timing_ = {};
  has_learned_ = false;
  residuals_.reset();
  start_at(t_ns, world_from_map_.inverse() * world_from_camera);
}

void IntensityTracker::start_at(TimeNs t_ns, const Rigid3& map_from_camera) {
  motion_.reset(t_ns, map_from_camera);
  last_event_ns_ = t_ns;
  mean_inlier_ratio_ = 0;
  low_inlier_batches_ = 0;
  pending_sums_ = {};
  pending_events_ = 0;
  candidates_tried_ = 0;
  is_lost_ = false;
  restart_pixels(kKnownSigma);
}

void IntensityTracker::restart_pixels(float sigma) {
  const ScopedTimer clock(timing_.view_s);
  residuals_.restart(motion_.pose(), sigma);
}

std::vector<TrackedPose> IntensityTracker::track(const Recording& recording,
                                                 const TrackProgress& progress) {
  Poses poses;
  Recording rest = recording;
  if (!knows_contrast_ && !has_learned_) learn_contrast(rest.events);
  while (!rest.events.empty()) {
    const std::optional<std::size_t> done = track_next(rest, poses);
    if (!done) break;
    rest.events = rest.events.subspan(*done);
    if (progress) progress(*done);
  }
  return poses;
}

std::optional<std::size_t> IntensityTracker::track_next(const Recording& recording, Poses& poses) {
  const std::span<const Event> events = recording.events;
  std::size_t done = 0;
  if (is_lost_) {
    done = relocate(recording, poses);
    if (done == 0) return std::nullopt;
  } else {
    const std::size_t count = next_batch(events);
    if (count == 0) return std::nullopt;
    done = events_before_gap(events.first(count));
    if (done == count || done >= kMinEventsBeforeGap)
      poses.push_back(track_batch(events.first(done)));
    if (done < count) lose();
  }
  if (done > 0) last_event_ns_ = events[done - 1].t_ns;
  return done;
}

std::size_t IntensityTracker::learning_events() const {
  constexpr double kEventsPerPixel = 3;
  return static_cast<std::size_t>(kEventsPerPixel * camera_.width * camera_.height);
}

void IntensityTracker::learn_contrast(std::span<const Event> events) {
  has_learned_ = true;
  const TimeNs start_ns = last_event_ns_;
  const Rigid3 start = motion_.pose();
  Poses poses;
  fallback_.reset(start_ns, world_from_map_ * start);
  const std::span<const Event> first = events.first(std::min(learning_events(), events.size()));
  fallback_.follow_all(first, poses, timing_);
  residuals_.begin_learning();
  std::span<const Event> rest = first;
  for (std::size_t i = 1; i + 1 < poses.size(); ++i) {
    const TimeNs end_ns = (poses[i].t_ns + poses[i + 1].t_ns) / 2;
    const std::size_t count = count_before(rest, end_ns);
    if (count == 0) continue;
    learn_from(rest.first(count), poses[i - 1], poses[i], poses[i + 1]);
    rest = rest.subspan(count);
  }
  residuals_.end_learning();
  start_at(start_ns, start);
}

void IntensityTracker::learn_from(std::span<const Event> events, const TrackedPose& before,
                                  const TrackedPose& pose, const TrackedPose& after) {
  const double span_s = seconds_from_ns(after.t_ns - before.t_ns);
  if (!(span_s > 0)) return;
  EventResidualBatch::Motion motion = motion_at(world_from_map_.inverse() * pose.world_from_camera);
  const Twist moved = (before.world_from_camera.inverse() * after.world_from_camera).log();
  motion.velocity = (moved / span_s).cast<float>();
  {
    const ScopedTimer clock(timing_.view_s);
    residuals_.prepare_view(world_from_map_.inverse() * pose.world_from_camera);
  }
  const ScopedTimer clock(timing_.load_s);
  residuals_.load(events, pose.t_ns, 0, motion);
  static_cast<void>(residuals_.evaluate(motion));
  residuals_.correct(0);
}

std::size_t IntensityTracker::next_batch(std::span<const Event> events) {
  if (options_.events)
    return events.size() >= static_cast<std::size_t>(*options_.events)
               ? static_cast<std::size_t>(*options_.events)
               : 0;
  // Enough pixels for a pose; more of them, until the image has moved by a fraction of a pixel, are as
  // good as simultaneous. Within less motion noise and the flicker of aliased texture say more than the
  // camera does: with at most 3000 pixels 29 of 36 worlds of one ray per pixel are held, with a third
  // of the sensor 33.
  constexpr double kLeastPixels = 500;
  constexpr double kMostPixels = 15000;
  constexpr double kMotion_px = 0.4;
  constexpr double kWidth = 240;
  // Of the same motion an edge's length gives proportionally more events and its passage over more
  // pixels as many again; but more pixels also tell more of the pose.
  constexpr double kPower = 1.5;
  const double wider = std::pow(std::max(1.0, camera_.width / kWidth), kPower);
  const auto least = static_cast<std::size_t>(std::lround(kLeastPixels * wider));
  const auto most = static_cast<std::size_t>(std::lround(kMostPixels * wider));
  // Where few pixels see edges a pose may not wait for so many: what is linear in a batch is so over a
  // pixel or two. Before anything is known of the motion a time keeps it short, or where many pixels
  // fire, as many events as tell the motion from their noise.
  constexpr std::size_t kFewestPixels = 100;
  constexpr double kMostMotion_px = 1.5;
  constexpr double kLongest_s = 0.015;
  constexpr double kFirst_s = 0.005;
  const std::size_t few_events = 2 * least, first_events = 20 * least;
  const double speed_px = image_speed_px();
  ++batch_;
  std::size_t pixels = 0;
  for (std::size_t i = 0; i < events.size(); ++i) {
    std::uint32_t& last = last_batch_[static_cast<std::size_t>(events[i].y) *
                                          static_cast<std::size_t>(camera_.width) +
                                      events[i].x];
    if (last != batch_) ++pixels;
    last = batch_;
    if (pixels < kFewestPixels && i < few_events) continue;
    const double time_s = seconds_from_ns(events[i].t_ns - events.front().t_ns);
    const double moved_px = speed_px * time_s;
    const bool is_enough = pixels >= most || (pixels >= least && moved_px >= kMotion_px);
    const bool is_first_long =
        speed_px == 0 && (i >= first_events || (i >= few_events && time_s >= kFirst_s));
    const bool is_long = moved_px >= kMostMotion_px || time_s >= kLongest_s || is_first_long;
    if (is_enough || is_long) return i + 1;
  }
  return 0;
}

std::size_t IntensityTracker::events_before_gap(std::span<const Event> events) const {
  // However fast the camera seems to move: a velocity from few events may be anything.
  constexpr double kShortest_s = 0.005;
  const double speed_px = image_speed_px();
  TimeNs before_ns = last_event_ns_;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const double gap_s = seconds_from_ns(events[i].t_ns - before_ns);
    if (gap_s > kShortest_s && gap_s * speed_px > kMaxMotionWithoutEvents_px) return i;
    before_ns = events[i].t_ns;
  }
  return events.size();
}

bool IntensityTracker::fits_worse(const Sums& sums, std::size_t events) {
  // Few events say little: those of several poses are judged together.
  constexpr std::size_t kEnough = 1000;
  constexpr double kUnknowns = 6;
  pending_sums_.known += sums.known;
  pending_sums_.inliers += sums.inliers;
  pending_events_ += events;
  if (pending_events_ < kEnough) return false;
  pending_events_ = 0;
  const Sums evidence = std::exchange(pending_sums_, {});
  if (evidence.known < kUnknowns) return true;  // the map is not in view
  const double inlier_ratio = evidence.inliers / evidence.known;
  constexpr int kPatience = 5;
  constexpr double kLearningRate = 0.01;
  // While the pixels are still uncertain fewer residuals fit.
  constexpr int kUncertain = 50;
  constexpr double kUncertainDrop = 0.6;
  if (mean_inlier_ratio_ == 0) mean_inlier_ratio_ = inlier_ratio;
  const bool is_certain = candidates_tried_ == 0;
  const double drop = kInlierDrop * (is_certain ? 1 : kUncertainDrop);
  if (inlier_ratio < drop * mean_inlier_ratio_) return ++low_inlier_batches_ >= kPatience;
  low_inlier_batches_ = 0;
  if (is_certain) mean_inlier_ratio_ += kLearningRate * (inlier_ratio - mean_inlier_ratio_);
  if (!is_certain && ++good_batches_ >= kUncertain) candidates_tried_ = 0;
  return false;
}

void IntensityTracker::lose() {
  if (candidates_tried_ == 0) lost_at_ = motion_.pose();
  is_lost_ = true;
  low_inlier_batches_ = 0;
  pending_sums_ = {};
  pending_events_ = 0;
}

Rigid3 IntensityTracker::candidate_pose(TimeNs t_ns) const {
  // Where it should be by now, where it was, and then around it in growing circles.
  const double gap_s = seconds_from_ns(t_ns - last_event_ns_);
  if (candidates_tried_ == 1) return lost_at_ * Rigid3::exp(motion_.velocity() * gap_s);
  if (candidates_tried_ == 2) return lost_at_;
  constexpr int kDirections = 8;
  constexpr double kRingSpacing_px = 6;
  const int ring = 1 + (candidates_tried_ - 3) / kDirections;
  const double angle = 2 * std::numbers::pi * (candidates_tried_ - 3) / kDirections;
  const double rotation = kRingSpacing_px * ring / camera_.fx;
  Twist offset = Twist::Zero();
  offset.tail<3>() << rotation * std::sin(angle), rotation * std::cos(angle), 0;
  return lost_at_ * Rigid3::exp(offset);
}

std::size_t IntensityTracker::relocate(const Recording& recording, Poses& poses) {
  const TimeNs t_ns = recording.events.front().t_ns;
  ++candidates_tried_;
  fallback_.reset_near(t_ns, world_from_map_ * candidate_pose(t_ns));
  const std::size_t known = poses.size();
  const std::size_t done = fallback_.follow(recording, poses, timing_);
  if (done == 0) --candidates_tried_;  // it is tried when there are more events
  for (std::size_t i = known; i < poses.size(); ++i) poses[i].status = TrackStatus::kLost;
  if (done == 0 || !fallback_.fits()) return done;
  is_lost_ = false;
  good_batches_ = 0;
  motion_ = fallback_.motion();
  restart_pixels(kFoundSigma);
  return done;
}

EventResidualBatch::Motion IntensityTracker::motion_at(const Rigid3& map_from_camera) const {
  const Rigid3 camera_from_map = map_from_camera.inverse();
  return {camera_from_map.rotation_matrix().cast<float>(),
          camera_from_map.translation().cast<float>(), motion_.velocity().cast<float>()};
}

TrackedPose IntensityTracker::track_batch(std::span<const Event> events) {
  TrackedPose pose;
  pose.first_ns = events.front().t_ns;
  pose.last_ns = events.back().t_ns;
  pose.t_ns = mean_time(events);
  const PosePrediction predicted = motion_.predict(pose.t_ns, residuals_.typical_depth_m());
  load(events, pose.t_ns, predicted.map_from_camera);
  const PoseEstimate<Sums> estimate = align(predicted);
  if (estimate.is_valid) {
    motion_.update(estimate.map_from_camera, estimate.information);
    const ScopedTimer clock(timing_.align_s);
    residuals_.correct(image_speed_px());
    residuals_.update_pixels_without_events(motion_at(estimate.map_from_camera));
  }
  pose.iterations = kIterations;
  pose.inlier_ratio = estimate.sums.known > 0 ? estimate.sums.inliers / estimate.sums.known : 0;
  if (fits_worse(estimate.sums, events.size())) {
    lose();
    pose.status = TrackStatus::kLost;
  }
  pose.residual =
      estimate.sums.weight > 0 ? std::sqrt(estimate.sums.squares / estimate.sums.weight) : 0;
  write_pose(pose);
  return pose;
}

void IntensityTracker::load(std::span<const Event> events, TimeNs t_ns,
                            const Rigid3& map_from_camera) {
  {
    const ScopedTimer clock(timing_.view_s);
    residuals_.prepare_view(map_from_camera);
  }
  const ScopedTimer clock(timing_.load_s);
  // An edge of area samples takes a whole pixel to pass.
  constexpr double kJump_px = 0.05;
  constexpr double kLongestJump_s = 2e-4;  // however slowly the camera seems to move
  const double jump_s = std::min(kLongestJump_s, kJump_px / std::max(1.0, image_speed_px()));
  residuals_.load(events, t_ns, jump_s, motion_at(map_from_camera));
}

auto IntensityTracker::align(const PosePrediction& predicted) -> PoseEstimate<Sums> {
  const ScopedTimer clock(timing_.align_s);
  constexpr double kSigma = LogIntensityResiduals::kSigma;
  PoseSolver pose(predicted, kInformation / (kSigma * kSigma));
  PoseEstimate<Sums> estimate;
  for (int i = 0; i <= kIterations; ++i) {
    estimate.map_from_camera = pose.map_from_camera();
    estimate.sums = residuals_.evaluate(motion_at(estimate.map_from_camera));
    // The last round is for the evidence.
    if (i < kIterations && !pose.step(estimate.sums)) return estimate;
  }
  estimate.information = pose.information(estimate.sums);
  estimate.is_valid = true;
  return estimate;
}

}  // namespace saccade
