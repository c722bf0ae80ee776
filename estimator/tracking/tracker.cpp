#include "estimator/tracking/tracker.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace saccade {
namespace {

/// Adds its lifetime to a sum of seconds.
class StageClock {
 public:
  explicit StageClock(double& seconds) : seconds_(seconds), start_(Clock::now()) {}
  ~StageClock() { seconds_ += std::chrono::duration<double>(Clock::now() - start_).count(); }
  StageClock(const StageClock&) = delete;
  StageClock& operator=(const StageClock&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  double& seconds_;
  Clock::time_point start_;
};

}  // namespace

Tracker::Tracker(const TrackerOptions& options, const PinholeCamera& camera, const MapPoints& map,
                 const Rigid3& world_from_map, std::uint64_t seed)
    : options_(options),
      camera_(camera.undistorted()),
      world_from_map_(world_from_map),
      seed_(seed),
      drawer_(camera_, options.templates, map),
      aligner_(options.align, camera_),
      frame_(camera, options.event_frame.drawing),
      motion_(options.motion) {}

void Tracker::reset(TimeNs t_ns, const Rigid3& world_from_camera) {
  motion_.reset(t_ns, world_from_map_.inverse() * world_from_camera);
  points_ = {};
  brightness_ = {};
  frame_index_ = 0;
  templates_drawn_ = 0;
  timing_ = {};
  suspicious_frames_ = 0;
}

std::vector<TrackedPose> Tracker::track(std::span<const Event> events,
                                        const std::function<void(std::size_t)>& progress) {
  std::vector<TrackedPose> poses;
  while (true) {
    prepare_template(motion_.pose());
    const std::size_t count = events_per_frame();
    if (events.size() < count) return poses;
    poses.push_back(track_frame(events.first(count)));
    events = events.subspan(count);
    if (progress) progress(count);
  }
}

void Tracker::prepare_template(const Rigid3& map_from_camera) {
  const StageClock clock(timing_.template_s);
  if (template_fits(map_from_camera)) return;
  map_from_template_ = map_from_camera;
  points_ = drawer_.draw(map_from_template_.inverse());
  aligner_.set_template(points_);
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
  const double count = options_.event_frame.ratio * static_cast<double>(points_.size());
  return std::max(static_cast<std::size_t>(options_.event_frame.min_events),
                  static_cast<std::size_t>(count));
}

void Tracker::draw_frame(std::span<const Event> events, TrackedPose& pose) {
  const StageClock clock(timing_.event_frame_s);
  pose.first_ns = events.front().t_ns;
  pose.last_ns = events.back().t_ns;
  pose.t_ns = mean_time(events);
  frame_.clear();
  frame_.draw(events);
}

AlignResult Tracker::align(TimeNs t_ns) {
  const StageClock clock(timing_.align_s);
  const Rigid3 predicted = motion_.predict(t_ns);
  return aligner_.align(frame_, predicted.inverse() * map_from_template_, brightness_, seed_,
                        frame_index_++);
}

TrackedPose Tracker::track_frame(std::span<const Event> events) {
  TrackedPose pose;
  pose.t_ns = mean_time(events);
  frame_.clear();
  frame_.draw(events);

  const Rigid3 predicted = motion_.predict(pose.t_ns);
  const AlignResult aligned = aligner_.align(frame_, predicted.inverse() * map_from_template_,
                                             brightness_, seed_, frame_index_++);
  pose.iterations = aligned.iterations;
  pose.inlier_ratio = aligned.inlier_ratio;
  pose.residual = aligned.residual;

  if (aligned.status == AlignStatus::kOk) {
    motion_.update(pose.t_ns, map_from_template_ * aligned.current_from_template.inverse());
    constexpr double kForget = 0.1;
    brightness_.gain += kForget * (aligned.brightness.gain - brightness_.gain);
    brightness_.offset += kForget * (aligned.brightness.offset - brightness_.offset);
  } else {
    motion_.stop();
  }
  const bool good =
      aligned.status == AlignStatus::kOk && aligned.inlier_ratio >= options_.lost.min_inlier_ratio;
  suspicious_frames_ = good ? 0 : suspicious_frames_ + 1;
  if (aligned.status != AlignStatus::kOk || suspicious_frames_ >= options_.lost.frames)
    pose.status = TrackStatus::kLost;
  pose.world_from_camera = world_from_map_ * motion_.pose();
  return pose;
}

}  // namespace saccade
