#include "estimator/tracking/intensity_tracker.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/check.h"
#include "estimator/mean_time.h"
#include "estimator/stage_clock.h"
#include "estimator/tracking/event_frame.h"
#include "estimator/tracking/posterior_pose.h"

namespace saccade {
namespace {

/// Fewer do not make a pose before a silence.
constexpr std::size_t kFewEvents = 100;
/// Pixels are said to be known as well at the start as after this many corrections.
constexpr float kKnownLooks = 10;
/// Beyond the image the view is drawn this much further than it may move before it is redrawn.
constexpr int kSpareNodes = 4;

/// Events go to random places: those of a later one are fetched that many events before.
constexpr std::size_t kAhead = 16;

/// In place of the pixel whose level an alignment corrects.
constexpr std::uint32_t kNotCorrected = std::numeric_limits<std::uint32_t>::max();

/// A view of some 240 columns is fine enough: what lies between its nodes is extrapolated.
int step_of(const PinholeCamera& camera) {
  constexpr double kColumns = 240;
  return std::max(1, static_cast<int>(std::lround(camera.width / kColumns)));
}

double redraw_px(const IntensityOptions& options, const PinholeCamera& camera) {
  return camera.fx * options.redraw_deg * std::numbers::pi / 180;
}

int margin_of(const IntensityOptions& options, const PinholeCamera& camera) {
  return static_cast<int>(std::ceil(redraw_px(options, camera) / step_of(camera))) + kSpareNodes;
}

/// Between its events a pixel is anywhere within a threshold: a uniform deviation beside the noise.
float trust_between_events(const EventContrast& contrast, double noise) {
  const double step = 0.5 * (contrast.on + contrast.off);
  return static_cast<float>(noise * noise / (noise * noise + step * step / 12));
}

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
      undistortion_(camera),
      map_(map),
      view_(map, margin_of(options, camera), step_of(camera)),
      levels_(camera.width, camera.height, contrast.on, contrast.off, options.correction),
      between_trust_(trust_between_events(contrast, options.noise)),
      motion_(motion, camera.fx),
      edges_(edges) {}

void IntensityTracker::reset(TimeNs t_ns, const Rigid3& world_from_camera) {
  motion_.reset(t_ns, map_.world_from_map().inverse() * world_from_camera);
  has_view_ = false;
  views_drawn_ = 0;
  timing_ = {};
  last_event_ns_ = t_ns;
  first_pixel_ = 0;
  usual_inliers_ = 0;
  misfits_ = 0;
  judged_ = {};
  attempts_ = 0;
  is_lost_ = false;
  draw_view(motion_.pose());
  start_levels(kKnownLooks);
}

void IntensityTracker::draw_view(const Rigid3& map_from_camera) {
  const StageClock clock(timing_.template_s);
  if (has_view_ && view_.moved_px(map_from_camera) < redraw_px(options_, camera_)) return;
  view_.draw(map_from_camera);
  list_steep_pixels();
  has_view_ = true;
  ++views_drawn_;
}

void IntensityTracker::start_levels(float looks) {
  levels_.forget();
  for (int y = 0; y < camera_.height; ++y)
    for (int x = 0; x < camera_.width; ++x) {
      const Eigen::Vector2f pixel = undistortion_(x, y);
      const Eigen::Vector2i node = view_.node_at(pixel);
      if (!view_.contains(node.x(), node.y())) continue;
      const SeenPlace& seen = view_(node.x(), node.y());
      if (!(seen.inverse_depth > 0)) continue;
      const Eigen::Vector2f offset = pixel - (view_.step_px() * node).cast<float>();
      const Eigen::Vector2f place = seen.place + seen.scale * offset;
      if (!is_inside(map_.atlas(), place.x(), place.y())) continue;
      const float level = sample(map_.atlas(), place.x(), place.y());
      if (!std::isfinite(level)) continue;
      levels_.set(static_cast<std::size_t>(y * camera_.width + x), level, looks);
    }
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
  const double speed_px = motion_.speed_px(view_.typical_depth_m());
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
  edges_.reset(t_ns, map_.world_from_map() * guess(t_ns), kUncertain_px);
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
  has_view_ = false;
  draw_view(motion_.pose());
  start_levels(1);
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
  const PosePrediction predicted = motion_.predict(pose.t_ns, view_.typical_depth_m());
  draw_view(predicted.map_from_camera);
  load(events, pose.t_ns, motion_at(predicted.map_from_camera));
  const Estimate estimate = align(predicted);
  if (estimate.is_valid) {
    motion_.update(estimate.map_from_camera, estimate.information);
    correct_levels();
  }
  pose.iterations = options_.iterations;
  pose.inlier_ratio = estimate.sums.visible > 0 ? estimate.sums.inliers / estimate.sums.visible : 0;
  if (fits_worse(estimate.sums, events.size())) {
    lose();
    pose.status = TrackStatus::kLost;
  }
  pose.residual =
      estimate.sums.weight > 0 ? std::sqrt(estimate.sums.squares / estimate.sums.weight) : 0;
  pose.world_from_camera = map_.world_from_map() * motion_.pose();
  pose.set_sigmas(motion_.covariance());
  return pose;
}

void IntensityTracker::load(std::span<const Event> events, TimeNs t_ns,
                            const EventChunk::Motion& motion) {
  const StageClock clock(timing_.event_frame_s);
  chunk_count_ = 0;
  loaded_pixels_.clear();
  const auto samples = static_cast<std::size_t>(options_.samples);
  // One in `every` events is aligned, the others only count for their pixels.
  const std::size_t every = (events.size() + samples - 1) / samples;
  const auto pixels = static_cast<std::size_t>(std::lround(
      options_.pixels_per_event * static_cast<double>(events.size()) / static_cast<double>(every)));
  bool has_pixels = pixels == 0;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const Event& event = events[i];
    // When the pose is sought, half of the events have happened.
    if (!has_pixels && event.t_ns >= t_ns) {
      load_pixels(pixels, motion);
      has_pixels = true;
    }
    const std::size_t ahead = std::min(i + kAhead, events.size() - 1);
    prefetch(events[ahead], ahead % every == 0);
    const std::size_t pixel = levels_.index(event);
    EventMeasurement measurement;
    measurement.level = levels_.step(pixel, event.polarity);
    if (i % every != 0) continue;
    measurement.pixel = undistortion_(event.x, event.y);
    measurement.time_s = static_cast<float>(seconds_from_ns(event.t_ns - t_ns));
    measurement.trust = levels_.trust(pixel);
    SeenPlace seen;
    if (!find_place(measurement.pixel, measurement.time_s, motion, seen)) continue;
    add(measurement, seen, static_cast<std::uint32_t>(pixel));
  }
}

void IntensityTracker::load_pixels(std::size_t count, const EventChunk::Motion& motion) {
  // Every n-th of those that tell where they look, others each time.
  const std::size_t every = std::max<std::size_t>(1, steep_pixels_.size() / count);
  constexpr std::size_t kNext = 7919;
  first_pixel_ = (first_pixel_ + kNext) % every;
  Eigen::Vector2f shift;
  for (std::size_t i = first_pixel_; i < steep_pixels_.size(); i += every) {
    const std::size_t pixel = steep_pixels_[i];
    const int x = static_cast<int>(pixel % static_cast<std::size_t>(camera_.width));
    const int y = static_cast<int>(pixel / static_cast<std::size_t>(camera_.width));
    EventMeasurement measurement;
    measurement.level = options_.half_step ? levels_.between(pixel) : levels_.level(pixel);
    measurement.pixel = undistortion_(x, y);
    measurement.time_s = 0;
    measurement.trust = between_trust_ * levels_.trust(pixel);
    SeenPlace seen;
    if (find_place(measurement.pixel, 0, motion, seen)) add(measurement, seen, kNotCorrected);
  }
}

void IntensityTracker::list_steep_pixels() {
  steep_pixels_.clear();
  if (!(options_.pixels_per_event > 0)) return;
  const auto least = static_cast<float>(options_.least_slope);
  const ImageF& atlas = map_.atlas();
  const int step = view_.step_px();
  for (int y = 0; y < camera_.height; y += step)
    for (int x = 0; x < camera_.width; x += step) {
      const Eigen::Vector2i node = view_.node_at(undistortion_(x, y));
      if (!view_.contains(node.x(), node.y())) continue;
      const SeenPlace& seen = view_(node.x(), node.y());
      if (!(seen.inverse_depth > 0)) continue;
      const int u = static_cast<int>(seen.place.x());
      const int v = static_cast<int>(seen.place.y());
      if (u < 0 || v < 0 || u + 1 >= atlas.width() || v + 1 >= atlas.height()) continue;
      const Eigen::Vector2f slope(atlas(u + 1, v) - atlas(u, v), atlas(u, v + 1) - atlas(u, v));
      // Not so where it is unknown.
      if ((seen.scale.transpose() * slope).squaredNorm() >= least * least)
        steep_pixels_.push_back(static_cast<std::uint32_t>(y * camera_.width + x));
    }
}

void IntensityTracker::add(const EventMeasurement& measurement, const SeenPlace& seen,
                           std::uint32_t pixel) {
  loaded_pixels_.push_back(pixel);
  if (chunk_count_ == 0 || chunks_[chunk_count_ - 1].size() == EventChunk::kCapacity) {
    if (chunk_count_ == chunks_.size()) chunks_.emplace_back();
    chunks_[chunk_count_++].clear();
  }
  chunks_[chunk_count_ - 1].add(measurement, seen);
}

void IntensityTracker::prefetch(const Event& event, bool is_aligned) const {
  levels_.prefetch(levels_.index(event));
  if (!is_aligned) return;
  const Eigen::Vector2i node = view_.node_at(undistortion_(event.x, event.y));
  if (view_.contains(node.x(), node.y())) __builtin_prefetch(&view_(node.x(), node.y()));
}

bool IntensityTracker::find_place(const Eigen::Vector2f& pixel, float time_s,
                                  const EventChunk::Motion& motion, SeenPlace& seen) const {
  const auto project = [&](const Eigen::Vector3f& point) -> Eigen::Vector2f {
    const Eigen::Vector3f at = motion.rotation * point + motion.translation;
    const Eigen::Vector3f v = motion.velocity.head<3>();
    const Eigen::Vector3f w = motion.velocity.tail<3>();
    const Eigen::Vector3f moved = at - time_s * (v + w.cross(at));
    return {
        static_cast<float>(camera_.fx) * moved.x() / moved.z() + static_cast<float>(camera_.cx),
        static_cast<float>(camera_.fy) * moved.y() / moved.z() + static_cast<float>(camera_.cy)};
  };
  const auto look = [&](const Eigen::Vector2f& at) -> const SeenPlace* {
    const Eigen::Vector2i node = view_.node_at(at);
    if (!view_.contains(node.x(), node.y())) return nullptr;
    const SeenPlace& place = view_(node.x(), node.y());
    return place.inverse_depth > 0 ? &place : nullptr;
  };
  // What is seen there now was elsewhere in the view that was drawn: one step of a fixed point.
  const SeenPlace* here = look(pixel);
  if (here == nullptr) return false;
  const Eigen::Vector2f before = pixel + (pixel - project(here->point));
  if (!before.allFinite()) return false;
  const SeenPlace* there = look(before);
  if (there == nullptr) return false;
  seen = *there;
  return true;
}

auto IntensityTracker::align(const PosePrediction& predicted) -> Estimate {
  const StageClock clock(timing_.align_s);
  const EventChunk::Noise noise{static_cast<float>(options_.noise),
                                static_cast<float>(options_.place_px)};
  PosteriorPose pose(predicted, options_.information / (options_.noise * options_.noise));
  Estimate estimate;
  for (int i = 0; i <= options_.iterations; ++i) {
    estimate.map_from_camera = pose.map_from_camera();
    const EventChunk::Motion motion = motion_at(estimate.map_from_camera);
    estimate.sums = {};
    for (std::size_t k = 0; k < chunk_count_; ++k) {
      chunks_[k].evaluate(camera_, map_.atlas(), motion);
      chunks_[k].weigh(noise);
      chunks_[k].add_to(estimate.sums);
    }
    // The last round is for the evidence.
    if (i < options_.iterations && !pose.step(estimate.sums)) return estimate;
  }
  estimate.information = pose.information(estimate.sums);
  estimate.is_valid = true;
  return estimate;
}

void IntensityTracker::correct_levels() {
  const StageClock clock(timing_.align_s);
  std::size_t i = 0;
  for (std::size_t k = 0; k < chunk_count_; ++k)
    for (int j = 0; j < chunks_[k].size(); ++j, ++i) {
      if (loaded_pixels_[i] == kNotCorrected) continue;
      const float excess = chunks_[k].residual(j);
      if (std::isfinite(excess)) levels_.correct(loaded_pixels_[i], excess);
    }
  for (const std::uint32_t pixel : loaded_pixels_)
    if (pixel != kNotCorrected) levels_.settle(pixel);
}

}  // namespace saccade
