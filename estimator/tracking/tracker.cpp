#include "estimator/tracking/tracker.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/stopwatch.h"

namespace saccade {
namespace {

/// Harmonic mean of the depths [m], by a few points spread over the template; 1 for none.
double typical_depth(std::span<const TemplatePoint> points) {
  constexpr std::size_t kProbes = 64;
  const std::size_t step = std::max<std::size_t>(1, points.size() / kProbes);
  double sum = 0;
  double count = 0;
  for (std::size_t i = 0; i < points.size(); i += step, ++count)
    sum += static_cast<double>(points[i].inverse_depth);
  return sum > 0 ? count / sum : 1;
}

/// Of a frame with the template, as the ratio of what this explains to what it does not; unlike the
/// inlier ratio it is 0 where they have nothing in common.
double agreement(const AlignResult& aligned) {
  const BrightnessModel& brightness = aligned.brightness;
  return brightness.gain > 0 ? brightness.gain * brightness.gain / brightness.variance : 0;
}

}  // namespace

Tracker::Tracker(const TrackerOptions& options, const PinholeCamera& camera, const MapPoints& map,
                 const Rigid3& world_from_map, std::uint64_t seed)
    : options_(options),
      camera_(camera.undistorted()),
      world_from_map_(world_from_map),
      seed_(seed),
      drawer_(camera_, options.templates, map),
      aligner_(options.align, camera_),
      coarse_(options.templates, options.align, camera_),
      window_(options.event_frame),
      frame_(camera, options.event_frame.drawing),
      motion_(options.motion, camera.fx) {}

void Tracker::reset(TimeNs t_ns, const Rigid3& world_from_camera, double deviation_px) {
  motion_.reset(t_ns, world_from_map_.inverse() * world_from_camera, deviation_px);
  points_ = {};
  brightness_ = {};
  is_brightness_known_ = false;
  frame_index_ = 0;
  templates_drawn_ = 0;
  timing_ = {};
  suspicious_frames_ = 0;
  usual_agreement_ = last_agreement_ = 0;
  unlike_frames_ = 0;
}

void Tracker::set_map(const MapPoints& map) {
  drawer_.set_map(map);
  points_ = {};
  is_brightness_known_ = false;  // another map lights another share of the pixels
}

void Tracker::start(std::span<const Event> events) {
  window_.start(events);
  frame_.clear();
}

std::optional<TrackedPose> Tracker::next() {
  if (!window_.advance(next_frame_events())) return std::nullopt;
  return track_frame();
}

std::vector<TrackedPose> Tracker::track(std::span<const Event> events,
                                        const std::function<void(std::size_t)>& progress) {
  std::vector<TrackedPose> poses;
  start(events);
  while (const std::optional<TrackedPose> pose = next()) {
    poses.push_back(*pose);
    if (progress) progress(window_.entered().size());
  }
  return poses;
}

std::size_t Tracker::next_frame_events() {
  prepare_template(motion_.pose());
  return events_per_frame();
}

void Tracker::prepare_template(const Rigid3& map_from_camera) {
  const ScopedTimer clock(timing_.template_s);
  if (template_fits(map_from_camera)) return;
  map_from_template_ = map_from_camera;
  points_ = drawer_.draw(map_from_template_.inverse());
  aligner_.set_template(points_);
  coarse_.set_template(drawer_);
  typical_depth_m_ = typical_depth(points_);
  ++templates_drawn_;
}

bool Tracker::template_fits(const Rigid3& map_from_camera) const {
  if (points_.empty() || options_.templates.redraw_px <= 0) return false;
  // How far a few points spread over the template have moved since it was drawn.
  constexpr std::size_t kProbes = 32;
  const Rigid3 camera_from_template = map_from_camera.inverse() * map_from_template_;
  const std::size_t step = std::max<std::size_t>(1, points_.size() / kProbes);
  double squared = 0;
  double probes = 0;
  for (std::size_t i = 0; i < points_.size(); i += step, ++probes) {
    const Eigen::Vector3d ray(points_[i].ray.x(), points_[i].ray.y(), 1);
    const Eigen::Vector3d moved = camera_from_template * (ray / points_[i].inverse_depth);
    if (moved.z() <= 0) return false;
    squared += (camera_.project(moved) - camera_.project(ray)).squaredNorm();
  }
  return squared < probes * options_.templates.redraw_px * options_.templates.redraw_px;
}

std::size_t Tracker::events_per_frame() const {
  const double count = options_.event_frame.ratio * static_cast<double>(drawer_.lit_pixels());
  return std::max(static_cast<std::size_t>(options_.event_frame.min_events),
                  static_cast<std::size_t>(count));
}

void Tracker::draw_frame(TrackedPose& pose) {
  const ScopedTimer clock(timing_.event_frame_s);
  const std::span<const Event> events = window_.events();
  pose.first_ns = events.front().t_ns;
  pose.last_ns = events.back().t_ns;
  if (options_.event_frame.kind == EventFrameOptions::Kind::kTimeSurface) {
    frame_.clear();
    pose.t_ns = frame_.draw_surface(events, time_constant(options_.event_frame, events));
  } else if (options_.event_frame.motion_compensation) {
    frame_.clear();
    pose.t_ns = window_.mean_time();
    frame_.draw_moved(events, pose.t_ns,
                      MotionField(camera_, motion_.velocity(), drawer_, typical_depth_m_));
  } else if (options_.event_frame.window == EventFrameOptions::Window::kSliding) {
    pose.t_ns = window_.mean_time();
    frame_.remove(window_.left());
    frame_.add(window_.entered());
  } else {
    frame_.clear();
    pose.t_ns = frame_.draw(events);
  }
}

AlignResult Tracker::align(TimeNs t_ns) {
  const ScopedTimer clock(timing_.align_s);
  const PosePrediction predicted = motion_.predict(t_ns, typical_depth_m_);
  const Rigid3 current_from_template = predicted.map_from_camera.inverse() * map_from_template_;
  // Events that earlier frames had, too, say nothing new: against them the prediction weighs more.
  const Matrix6 precision = predicted.precision / window_.share_of_new();
  const std::optional<Rigid3> first_guess =
      coarse_.approach(frame_, current_from_template, precision, seed_, frame_index_);
  if (!std::exchange(is_brightness_known_, true))
    brightness_ = aligner_.measure_brightness(frame_, first_guess.value_or(current_from_template));
  return aligner_.align(frame_, current_from_template, precision, brightness_, seed_,
                        frame_index_++, first_guess);
}

TrackedPose Tracker::track_frame() {
  TrackedPose pose;
  draw_frame(pose);
  const AlignResult aligned = align(pose.t_ns);
  if (aligned.status == AlignStatus::kOk)
    take(aligned);
  else
    motion_.stop();
  pose.status = judge(aligned);
  compare_to_usual(aligned);
  write_evidence(aligned, pose);
  last_ = pose;
  return pose;
}

void Tracker::take(const AlignResult& aligned) {
  motion_.update(map_from_template_ * aligned.current_from_template.inverse(),
                 aligned.information * window_.share_of_new());
  brightness_.learn(aligned.brightness);
}

void Tracker::write_evidence(const AlignResult& aligned, TrackedPose& pose) const {
  pose.iterations = aligned.iterations;
  pose.inlier_ratio = aligned.inlier_ratio;
  pose.residual = aligned.residual;
  pose.world_from_camera = world_from_map_ * motion_.pose();
  pose.set_sigmas(motion_.covariance());
}

TrackStatus Tracker::judge(const AlignResult& aligned) {
  if (aligned.status != AlignStatus::kOk) return TrackStatus::kLost;
  const bool suspicious = aligned.inlier_ratio < options_.lost.min_inlier_ratio;
  suspicious_frames_ = suspicious ? suspicious_frames_ + 1 : 0;
  return suspicious_frames_ >= options_.lost.frames ? TrackStatus::kLost : TrackStatus::kOk;
}

void Tracker::compare_to_usual(const AlignResult& aligned) {
  constexpr double kUnlike = 0.25, kMemory = 0.05;
  last_agreement_ = aligned.status == AlignStatus::kOk ? agreement(aligned) : 0;
  unlike_frames_ = last_agreement_ < kUnlike * usual_agreement_ ? unlike_frames_ + 1 : 0;
  usual_agreement_ = usual_agreement_ == 0 ? last_agreement_
                                           : std::lerp(usual_agreement_, last_agreement_, kMemory);
}

std::optional<TrackedPose> Tracker::relocate(std::span<const Rigid3> world_from_camera) {
  // What a place is off by, the share of the usual agreement that it must reach, and how much
  // better than that of the last frame it must be.
  constexpr double kPlace_px = 6;
  constexpr double kShare = 0.5, kGain = 2;
  const MotionModel before = motion_;
  std::optional<AlignResult> best;
  double best_agreement = std::max(kShare * usual_agreement_, kGain * last_agreement_);
  MotionModel best_motion = motion_;
  TrackedPose pose = last_;
  for (const Rigid3& place : world_from_camera) {
    const Rigid3 map_from_place = world_from_map_.inverse() * place;
    points_ = {};
    prepare_template(map_from_place);
    // As many events as this template wants: of that from astray there may be next to none.
    const std::span<const Event> events = window_.newest(events_per_frame());
    frame_.clear();
    const TimeNs t_ns = frame_.draw(events);
    motion_.reset(t_ns, map_from_place, kPlace_px);
    is_brightness_known_ = false;
    const AlignResult aligned = align(t_ns);
    if (aligned.status != AlignStatus::kOk || agreement(aligned) <= best_agreement) continue;
    best_agreement = agreement(aligned);
    take(aligned);
    best = aligned;
    best_motion = motion_;
    pose.t_ns = t_ns;
    pose.first_ns = events.front().t_ns;
  }
  frame_.clear();
  if (options_.event_frame.window == EventFrameOptions::Window::kSliding)
    frame_.add(window_.events());
  motion_ = best ? best_motion : before;
  points_ = {};
  is_brightness_known_ = false;
  if (!best) return std::nullopt;
  suspicious_frames_ = unlike_frames_ = 0;
  pose.status = TrackStatus::kRelocalised;
  write_evidence(*best, pose);
  return pose;
}

}  // namespace saccade
