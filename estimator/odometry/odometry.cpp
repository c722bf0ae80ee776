#include "estimator/odometry/odometry.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <future>

#include "core/error.h"
#include "core/process/parallel.h"
#include "core/stopwatch.h"
#include "core/time_search.h"
#include "estimator/edges/least_squares/path_covariance.h"
#include "estimator/odometry/view_turn.h"
#include "estimator/tracking/pose_output.h"

namespace saccade {
namespace {

/// The camera is searched for so often, in the events' time, and first where it was kLookBack_s
/// before, ahead of the frames that diverged.
constexpr double kSearchInterval_s = 0.01, kLookBack_s = 0.05;

/// Number of leading events until `t_s`.
std::size_t count_until_s(std::span<const Event> events, double t_s) {
  return count_until(events, ns_from_seconds(t_s));
}

bool is_fixed(const PathEstimate& start) { return start.fixed_until_s >= start.poses.end_s(); }

/// The poses of a start that are an output: those that were not given.
std::vector<TrackedPose> found_poses(const PathEstimate& start) {
  std::vector<TrackedPose> poses;
  for (const StampedPose& pose : start.poses.poses()) {
    if (pose.t_s <= start.given_until_s) continue;
    TrackedPose tracked;
    tracked.t_ns = tracked.first_ns = tracked.last_ns = ns_from_seconds(pose.t_s);
    tracked.world_from_camera = pose.world_from_camera;
    poses.push_back(tracked);
  }
  return poses;
}

/// The path with the poses that a mapping adjusted, up to the end of its events.
Trajectory with_adjusted(const Trajectory& path, const Mapping& mapping, double held_until_s) {
  const Trajectory adjusted(mapping.poses);
  std::vector<StampedPose> poses;
  for (StampedPose pose : path.poses()) {
    if (pose.t_s > adjusted.end_s()) break;
    if (pose.t_s >= adjusted.start_s() && pose.t_s > held_until_s)
      pose.world_from_camera = adjusted.at_clamped(pose.t_s);
    poses.push_back(pose);
  }
  return Trajectory(std::move(poses));
}

/// How far apart the poses of a keyframe's events lie [m], as if its view were in their middle.
double baseline_of(const Keyframe& keyframe, std::span<const StampedPose> path) {
  double furthest_m = 0;
  for (const StampedPose& pose : path) {
    if (pose.t_s < keyframe.start_s || pose.t_s > keyframe.end_s) continue;
    furthest_m = std::max(
        furthest_m,
        (pose.world_from_camera.translation() - keyframe.world_from_camera.translation()).norm());
  }
  return 2 * furthest_m;
}

/// Edges are fitted once, to the smoothed path, where there is one.
MappingOptions mapping_options(const OdometryOptions& options) {
  MappingOptions mapping = options.mapping;
  mapping.adjustment.fits_edges = options.smoothing.lag_s <= 0;
  return mapping;
}

/// Of each keyframe as many edges as its own adjustment has.
FixedLagOptions smoothing_options(const OdometryOptions& options) {
  FixedLagOptions smoothing = options.smoothing;
  smoothing.problem.edges = options.mapping.adjustment.edges;
  smoothing.problem.solver = options.mapping.adjustment.solver;
  return smoothing;
}

}  // namespace

/// A keyframe in the making.
struct Odometry::Job {
  double made_s = 0;
  double seconds = 0;  ///< of work
  std::future<Mapping> mapping;
};

Odometry::Odometry(const OdometryOptions& options, const PinholeCamera& camera, std::uint64_t seed)
    : options_(options),
      camera_(camera),
      mapper_(mapping_options(options), camera),
      map_(options.keyframe.active, camera),
      smoother_(smoothing_options(options), camera),
      tracker_(options.tracker, camera, map_.points(), Rigid3(), seed) {
  batch_.problem.solver = options.mapping.adjustment.solver;
  batch_.use_imu = options.batch_adjustment == BatchMode::kEventsAndImu;
  start_.min_edges = static_cast<std::size_t>(options.mapping.min_edges);
  start_.refinement.adjustment.solver = batch_.problem.solver;
  start_.refinement.limits = options.mapping.depth.limits;
}

Odometry::~Odometry() = default;

void Odometry::set_gyroscope(Gyroscope gyroscope) {
  gyroscope_ = gyroscope;
  tracker_.set_gyroscope(std::move(gyroscope));
}

OdometryResult Odometry::run(std::span<const Event> events, const PathEstimate& start,
                             const std::function<void(std::size_t)>& progress) {
  OdometryResult result;
  monitor_.emplace(camera_, Recording{.events = events});
  {
    const ScopedTimer clock(result.mapping_s);
    if (!start_from(first_map(events, start, mapper_, camera_, start_, gyroscope_), result)) {
      result.trial.outcome = StartTrial::Outcome::kNoMap;
      return result;
    }
  }
  const double trial_from_s = start.poses.end_s();
  bool is_on_trial = start.given_until_s == kNoGivenPoses;
  Stream stream{events, count_until_s(events, path_.back().t_s)};
  if (progress) progress(stream.done);
  tracker_.start(stream.rest());
  const EventClock clock(stream.rest().empty() ? 0 : stream.rest().front().t_ns);
  while (!stream.rest().empty()) {
    const std::size_t before = stream.done;
    if (options_.mode == OdometryMode::kOnline) await_frame(clock, stream, result);
    std::optional<TrackedPose> pose;
    {
      const ScopedTimer work(result.tracking_s);
      pose = tracker_.next();
    }
    if (!pose) break;
    const double now_s = seconds_from_ns(pose->last_ns);
    stream.done += count_until_s(stream.rest(), now_s);
    if (options_.mode == OdometryMode::kOnline)
      result.latency_ms.push_back(clock.age_ms(pose->last_ns));
    if (progress) progress(stream.done - before);
    add_pose(*pose, result);
    if (is_on_trial && now_s > trial_from_s + kStartTrial_s) {
      result.trial = start_trial(result.poses, events, trial_from_s);
      is_on_trial = false;
      if (!result.trial.is_passed()) break;
    }
    if (!job_ && !is_lost_ && wants_keyframe()) begin_mapping(events.first(stream.done), now_s);
    if (job_ && is_due(now_s)) end_mapping(now_s, result);
  }
  if (is_on_trial) result.trial = start_trial(result.poses, events, trial_from_s);
  if (!result.trial.is_passed()) {
    job_.reset();
    return result;
  }
  if (job_) end_mapping(path_.back().t_s, result);
  if (wants_last_keyframe()) {
    begin_mapping(events, path_.back().t_s);
    end_mapping(path_.back().t_s, result);
  }
  output(result);
  if (result.is_scale_guessed) lose_distant_poses(result);
  return result;
}

void Odometry::await_frame(const EventClock& clock, Stream& stream, OdometryResult& result) {
  const auto last_of_frame = [&] {
    const std::size_t count = std::min(tracker_.next_frame_events(), stream.rest().size());
    return count == 0 ? stream.all.back().t_ns : stream.rest()[count - 1].t_ns;
  };
  if (clock.age_ms(last_of_frame()) > options_.max_age_ms) {
    const std::size_t late = count_until_s(stream.rest(), seconds_from_ns(clock.now_ns()));
    result.dropped_events += late;
    stream.done += late;
    tracker_.start(stream.rest());
  }
  clock.wait_for(last_of_frame());
}

void Odometry::add_pose(TrackedPose pose, OdometryResult& result) {
  const double now_s = seconds_from_ns(pose.last_ns);
  const bool may_be_lost =
      tracker_.is_lost() ||
      (options_.relocation == Relocation::kInconsistent && !tracker_.is_consistent());
  if (may_be_lost && options_.relocation != Relocation::kNever &&
      now_s >= last_search_s_ + kSearchInterval_s) {
    last_search_s_ = now_s;
    pose = relocate().value_or(pose);
  }
  if (pose.status == TrackStatus::kRelocalised) discard_diverged_poses(pose, result);
  is_lost_ = pose.status == TrackStatus::kLost;
  if (is_lost_) lost_ns_.push_back(pose.t_ns);
  {
    const ScopedTimer clock(result.check_s);
    monitor_->judge(pose);
  }
  result.poses.push_back(pose);
  if (is_lost_) return;
  if (const double t_s = seconds_from_ns(pose.t_ns); t_s > path_.back().t_s)
    path_.push_back({t_s, pose.world_from_camera});
}

void Odometry::discard_diverged_poses(const TrackedPose& found, OdometryResult& result) {
  const double t_s = seconds_from_ns(found.t_ns);
  // The keyframe in the making rests on diverged poses, and so do poses at the same time.
  job_.reset();
  smoother_.clear();
  monitor_->restart();
  while (!result.poses.empty() && result.poses.back().t_ns >= found.t_ns) result.poses.pop_back();
  while (path_.size() > 1 && path_.back().t_s >= t_s) path_.pop_back();
  while (!lost_ns_.empty() && lost_ns_.back() >= found.t_ns) lost_ns_.pop_back();
  mapped_from_s_ = seconds_from_ns(found.last_ns);
  fixed_until_s_ = std::max(fixed_until_s_, t_s);
}

std::optional<TrackedPose> Odometry::relocate() {
  // Where it was before it diverged, then at every keyframe, the newest first.
  const Trajectory path(path_);
  const double before_s = path.end_s() - kLookBack_s;
  const std::array<Rigid3, 2> recent = {path.poses().back().world_from_camera,
                                        path.at_clamped(before_s)};
  if (auto pose = tracker_.relocate(recent)) return pose;
  const std::vector<std::size_t> active = map_.active();
  for (std::size_t i = map_.keyframes().size(); i-- > 0;) {
    const Rigid3 world_from_camera = map_.keyframes()[i].world_from_camera;
    map_.activate_around(i, world_from_camera);
    take_map();
    if (auto pose = tracker_.relocate({&world_from_camera, 1})) return pose;
  }
  map_.activate(active);
  take_map();
  return std::nullopt;
}

void Odometry::take(Keyframe keyframe, const Rigid3& world_from_camera) {
  baseline_m_ = std::max(baseline_m_, baseline_of(keyframe, path_));
  map_.add(std::move(keyframe), world_from_camera);
  take_map();
}

void Odometry::take_map() {
  tracker_.set_map(map_.points());
  monitor_->set_map(map_.points(), Rigid3());
}

bool Odometry::is_due(double now_s) const {
  if (options_.mode == OdometryMode::kOffline)
    return now_s >= job_->made_s + options_.keyframe.handover_s;
  return job_->mapping.wait_for(std::chrono::seconds(0)) != std::future_status::timeout;
}

bool Odometry::start_from(FirstMap first, OdometryResult& result) {
  Keyframe& keyframe = first.mapping.keyframe;
  const bool has_map = keyframe.edges.size() >= Mapper::kMinEdges;
  if (!has_map && first.path.given_until_s == kNoGivenPoses) return false;
  if (!has_map)
    throw InputError("start",
                     "the events of the known poses show no edges in depth: the camera must "
                     "move sideways there: begin later (--start-s), or make start.truth_s longer");
  mapped_from_s_ = keyframe.start_s - 1e-9;
  path_.assign(first.path.poses.poses().begin(), first.path.poses.poses().end());
  fixed_until_s_ = first.path.fixed_until_s;
  given_until_s_ = first.path.given_until_s;
  held_until_s_ = std::max(fixed_until_s_, given_until_s_);
  result.poses = found_poses(first.path);
  if (given_until_s_ != kNoGivenPoses) {
    result.extrapolated_s = path_.back().t_s - given_until_s_;
    result.is_scale_guessed = is_scale_guessed_ =
        options_.mapping.edges == MappingOptions::Edges::kDepth && first.is_scale_guessed();
  }
  typical_depth_m_ = keyframe.typical_depth_m;
  if (!is_fixed(first.path)) apply_adjusted_poses(first.mapping);
  last_keyframe_ = path_.back();
  interval_from_s_ = last_keyframe_.t_s;
  if (smoother_.is_enabled()) smooth(first.path, first.mapping);
  take(std::move(keyframe), last_keyframe_.world_from_camera);
  output(result);
  for (TrackedPose& pose : result.poses) monitor_->judge(pose);
  tracker_.reset(ns_from_seconds(last_keyframe_.t_s), last_keyframe_.world_from_camera);
  return true;
}

double Odometry::moved_m() const {
  return (path_.back().world_from_camera.translation() -
          last_keyframe_.world_from_camera.translation())
      .norm();
}

double Odometry::doubling_m() const {
  // Below a pixel of parallax there is nothing to double.
  return std::max(baseline_m_, typical_depth_m_ / camera_.fx);
}

bool Odometry::has_doubled_baseline() const {
  // Depths of a short start are off by some ten percent, and the path with them: with twice the
  // baseline they are twice as good.
  return options_.keyframe.doubles_baseline && moved_m() >= doubling_m() &&
         doubling_m() < options_.keyframe.distance * typical_depth_m_;
}

bool Odometry::has_turned() const {
  return options_.keyframe.turn > 0 &&
         view_turn(last_keyframe_.world_from_camera, path_.back().world_from_camera) >=
             options_.keyframe.turn * angle_of_view(camera_);
}

bool Odometry::wants_keyframe() const {
  if (has_doubled_baseline() || has_turned()) return true;
  double interval_s = options_.keyframe.interval_s;
  double distance_m = options_.keyframe.distance * typical_depth_m_;  // d_kf
  const double quarter_s = (path_.back().t_s - path_.front().t_s) / 4;
  if (options_.keyframe.doubles_baseline && quarter_s < interval_s) {
    // Windows of a short path are short: they cost little, and with a quarter more of it depths are
    // a quarter better. Until then the camera is tracked by depths that may be poor. Each of such
    // keyframes would hand its errors on to the next, if the path were not smoothed.
    interval_s = quarter_s;
    if (smoother_.is_enabled()) distance_m = std::min(distance_m, baseline_m_ / 4);
  }
  return path_.back().t_s >= interval_from_s_ + interval_s && moved_m() >= distance_m;
}

bool Odometry::wants_last_keyframe() const {
  const bool adjusts_path = smoother_.is_enabled() && options_.mapping.adjust_rounds > 0;
  return adjusts_path && !is_lost_ && path_.back().t_s > last_keyframe_.t_s;
}

void Odometry::begin_mapping(std::span<const Event> events, double now_s) {
  job_ = std::make_unique<Job>();
  job_->made_s = now_s;
  // Whatever becomes of this keyframe, the next one waits for more: a few of them reach d_kf.
  if (has_doubled_baseline())
    baseline_m_ = 2 * doubling_m();
  else
    interval_from_s_ = path_.back().t_s;
  last_keyframe_ = path_.back();
  const auto policy = thread_count() > 1 ? std::launch::async : std::launch::deferred;
  const std::span<const Event> mapped = events.subspan(count_until_s(events, mapped_from_s_));
  job_->mapping = std::async(
      policy,
      [this, mapped, seconds = &job_->seconds,
       path = PathEstimate{
           Trajectory(path_), fixed_until_s_, given_until_s_, typical_depth_m_,
           map_.landmarks(now_s - options_.mapping.duration_s, path_.back().world_from_camera),
           map_.landmarks(now_s - options_.smoothing.lag_s - options_.mapping.duration_s,
                          path_.back().world_from_camera)}] {
        const ScopedTimer clock(*seconds);
        return map(mapped, path);
      });
}

Mapping Odometry::map(std::span<const Event> events, const PathEstimate& path) {
  Mapping mapping = mapper_.map(events, path);
  if (smoother_.is_enabled()) smooth(path, mapping);
  return mapping;
}

void Odometry::smooth(const PathEstimate& path, Mapping& mapping) {
  if (!mapping.edges || mapping.keyframe.edges.size() < Mapper::kMinEdges) return;
  Keyframe& keyframe = mapping.keyframe;
  const Trajectory adjusted = with_adjusted(path.poses, mapping, held_until_s_);
  const ViewWindow window{mapping.edges->events, &adjusted, keyframe.t_s};
  smoother_.add(smoother_.view(window, mapping.edges->edges, held_until_s_), held_until_s_);
  const Trajectory smoothed =
      smoother_.smooth(adjusted, held_until_s_, keyframe.typical_depth_m, path.settled)
          .value_or(adjusted);
  mapping.world_from_before = smoothed.at_clamped(keyframe.end_s) *
                              adjusted.at_clamped(keyframe.end_s).inverse() *
                              mapping.world_from_before;
  mapping.poses.assign(smoothed.poses().begin(), smoothed.poses().end());
  mapper_.refit(smoothed, path, mapping);
}

void Odometry::end_mapping(double now_s, OdometryResult& result) {
  const std::unique_ptr<Job> job = std::move(job_);
  Mapping mapping = job->mapping.get();
  Keyframe& keyframe = mapping.keyframe;
  result.mapping_s += job->seconds;
  // Too few edges make no keyframe: the map of before goes on.
  if (keyframe.edges.size() < Mapper::kMinEdges) return;
  typical_depth_m_ = keyframe.typical_depth_m;
  // A view that turns back would see more of what was before: keyframes stay in order.
  mapped_from_s_ = std::max(mapped_from_s_, keyframe.start_s - 1e-9);
  fixed_until_s_ = std::max(fixed_until_s_, keyframe.end_s - options_.keyframe.active_window_s);
  apply_adjusted_poses(mapping);
  move_keyframes(mapping.poses.front().t_s);
  take(std::move(keyframe), path_.back().world_from_camera);
  result.changes.push_back({job->made_s, now_s, map_.keyframes().size() - 1, map_.active()});
}

void Odometry::apply_adjusted_poses(const Mapping& mapping) {
  const Trajectory adjusted(mapping.poses);
  for (StampedPose& pose : path_) {
    if (pose.t_s < adjusted.start_s() || pose.t_s <= held_until_s_) continue;
    pose.world_from_camera = pose.t_s <= adjusted.end_s()
                                 ? adjusted.at_clamped(pose.t_s)
                                 : mapping.world_from_before * pose.world_from_camera;
  }
  tracker_.correct(mapping.world_from_before);
}

void Odometry::move_keyframes(double from_s) {
  if (!smoother_.is_enabled()) return;
  const Trajectory path(path_);
  for (Keyframe& keyframe : map_.keyframes())
    if (keyframe.t_s > std::max(from_s, held_until_s_))
      move_to(path.at_clamped(keyframe.t_s), keyframe);
}

bool Odometry::wants_batch_adjustment() const {
  return options_.batch_adjustment != BatchMode::kNone && options_.mode == OdometryMode::kOffline &&
         lost_ns_.empty() && !is_scale_guessed_;
}

void Odometry::adjust(std::span<const Event> events, const PathEstimate& start,
                      OdometryResult& result, const std::function<void(std::size_t)>& progress) {
  const ScopedTimer clock(result.batch_s);
  BatchInput batch;
  batch.path = path_;
  for (const StampedPose& pose : start.poses.poses())
    if (pose.t_s <= start.fixed_until_s) batch.given.push_back(pose);
  for (const Keyframe& keyframe : map_.keyframes()) batch.keyframe_s.push_back(keyframe.t_s);
  batch.typical_depth_m = typical_depth_m_;
  batch.imu = imu_;
  batch.is_metric = start.given_until_s != kNoGivenPoses;
  const BatchAdjustment adjusted = adjust_batch(within(events, Trajectory(path_)), batch, camera_,
                                                mapper_.rays(), batch_, progress);
  for (StampedPose& pose : path_) pose.world_from_camera = adjusted.path.at_clamped(pose.t_s);
  std::vector<Keyframe>& keyframes = map_.keyframes();
  parallel_for(keyframes.size(),
               [&](std::size_t i) { mapper_.renew(events, adjusted.path, keyframes[i]); });
  output(result);
  if (!adjusted.covariances.empty())
    result.covariances =
        set_sigmas(result.poses, [&](double t_s) { return adjusted.covariance_at(t_s); });
  result.inertial = adjusted.inertial;
}

void Odometry::add_images(std::span<const Event> events,
                          const std::function<void(std::size_t)>& progress) {
  const Trajectory poses(path_);
  std::vector<Keyframe>& keyframes = map_.keyframes();
  parallel_for(keyframes.size(), [&](std::size_t i) {
    mapper_.add_image(events, poses, keyframes[i]);
    if (progress) progress(1);
  });
}

void Odometry::lose_distant_poses(OdometryResult& result) const {
  // A pose is lost that is off by 5 % of the depth. The guess may be wrong by a factor of two and a
  // half, and so may the way that the camera seems to have gone.
  constexpr double kLostFraction = 0.02;
  const Eigen::Vector3d given = Trajectory(path_).at_clamped(given_until_s_).translation();
  for (TrackedPose& pose : result.poses) {
    const double moved_m = (pose.world_from_camera.translation() - given).norm();
    if (moved_m <= kLostFraction * typical_depth_m_) continue;
    pose.status = TrackStatus::kLost;
    pose.probability = std::min(0.5, pose.probability);
  }
}

void Odometry::output(OdometryResult& result) const {
  const Trajectory adjusted(path_);
  for (TrackedPose& pose : result.poses)
    pose.world_from_camera = adjusted.at_clamped(seconds_from_ns(pose.t_ns));
}

}  // namespace saccade
