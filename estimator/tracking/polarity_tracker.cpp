#include "estimator/tracking/polarity_tracker.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/stopwatch.h"
#include "estimator/mean_time.h"
#include "estimator/tracking/event_frame.h"
#include "estimator/tracking/posterior_pose.h"

namespace saccade {
namespace {

/// What the last pose is off by when the edges take over, as image motion.
constexpr double kLost_px = 4;

}  // namespace

/// The outcome of one alignment.
struct PolarityTracker::Estimate {
  Rigid3 map_from_camera;
  Matrix6 information = Matrix6::Zero();
  IncrementChunk::Sums sums;
  bool is_valid = false;
};

PolarityTracker::PolarityTracker(const PolarityOptions& options, const PredictionOptions& motion,
                                 const PinholeCamera& camera, const IntensityMap& map,
                                 Tracker& edges)
    : options_(options),
      camera_(camera.undistorted()),
      map_(map),
      view_(map, 0),
      template_(camera_),
      frame_(camera, options.reversals),
      motion_(motion, camera.fx),
      edges_(edges) {}

void PolarityTracker::reset(TimeNs t_ns, const Rigid3& world_from_camera) {
  motion_.reset(t_ns, map_.world_from_map().inverse() * world_from_camera);
  edges_.reset(t_ns, world_from_camera);
  frame_.forget();
  has_view_ = false;
  by_edges_ = true;
  views_drawn_ = 0;
  timing_ = {};
}

std::vector<TrackedPose> PolarityTracker::track(std::span<const Event> events,
                                                const std::function<void(std::size_t)>& progress) {
  Poses poses;
  const auto count = static_cast<std::size_t>(options_.events);
  while (events.size() >= count) {
    std::size_t done = count;
    if (by_edges_ || !track_frame(events.first(count), poses)) {
      done = follow_edges(events, poses);
      if (done == 0) break;  // too few events are left
    }
    events = events.subspan(done);
    if (progress) progress(done);
  }
  return poses;
}

std::size_t PolarityTracker::follow_edges(std::span<const Event> events, Poses& poses) {
  constexpr std::size_t kFrames = 6;
  const std::size_t done = kFrames * edges_.next_frame_events();
  if (done > events.size()) return 0;
  Poses found = edges_.track(events.first(done));
  timing_ += edges_.timing();
  double inliers = 0;
  for (const TrackedPose& pose : found)
    inliers += pose.inlier_ratio / static_cast<double>(found.size());
  by_edges_ = inliers < edges_.least_inlier_ratio();
  if (by_edges_)
    for (TrackedPose& pose : found) pose.status = TrackStatus::kLost;
  poses.insert(poses.end(), found.begin(), found.end());
  motion_ = edges_.motion();
  frame_.forget();
  draw_view(motion_.pose());
  return done;
}

void PolarityTracker::draw_view(const Rigid3& map_from_camera) {
  const ScopedTimer clock(timing_.template_s);
  if (has_view_ && view_.moved_px(map_from_camera) < options_.redraw_px) return;
  view_.draw(map_from_camera);
  template_.draw(view_, map_.atlas());
  has_view_ = true;
  ++views_drawn_;
}

bool PolarityTracker::track_frame(std::span<const Event> events, Poses& poses) {
  TrackedPose pose;
  pose.first_ns = events.front().t_ns;
  pose.last_ns = events.back().t_ns;
  pose.t_ns = mean_time(events);
  const Rigid3 last = motion_.pose();
  const PosePrediction predicted = motion_.predict(pose.t_ns, view_.typical_depth_m());
  draw_view(predicted.map_from_camera);
  {
    const ScopedTimer clock(timing_.event_frame_s);
    frame_.draw(events, pose.t_ns, ImageMotion(camera_, motion_.velocity()), view_);
  }
  const Estimate estimate = align(predicted);
  const IncrementChunk::Sums& sums = estimate.sums;
  pose.inlier_ratio = sums.agreement();
  if (!estimate.is_valid || pose.inlier_ratio < options_.min_agreement) {
    edges_.reset(pose.first_ns, map_.world_from_map() * last, kLost_px);
    return false;
  }
  motion_.update(estimate.map_from_camera, estimate.information);
  pose.iterations = options_.iterations;
  pose.residual = sums.weight > 0 ? std::sqrt(sums.squares / sums.weight) : 0;
  pose.world_from_camera = map_.world_from_map() * motion_.pose();
  pose.set_sigmas(motion_.covariance());
  poses.push_back(pose);
  return true;
}

IncrementChunk::Sums PolarityTracker::compare(const IncrementPoints& points,
                                              const Rigid3& current_from_template, double gain) {
  const IncrementChunk::Noise noise{static_cast<float>(options_.noise),
                                    static_cast<float>(options_.place_px)};
  IncrementChunk::Sums sums;
  for (std::size_t first = 0; first < points.count; first += IncrementChunk::kCapacity) {
    chunk_.evaluate(camera_, frame_.image(), points, first, current_from_template, gain, noise);
    chunk_.add_to(sums);
  }
  return sums;
}

auto PolarityTracker::align(const PosePrediction& predicted) -> Estimate {
  const ScopedTimer clock(timing_.align_s);
  const auto template_at = [&](const Rigid3& map_from_camera) {
    return map_from_camera.inverse() * view_.map_from_camera();
  };
  const Rigid3 start = template_at(predicted.map_from_camera);
  const IncrementPoints& points =
      template_.points(start.inverse().adjoint() * motion_.velocity(), options_.min_slope);
  Estimate estimate;
  estimate.sums = compare(points, start, 0);
  if (!(estimate.sums.product > 0)) return estimate;
  double gain = estimate.sums.product / estimate.sums.expected;
  PosteriorPose pose(predicted, options_.information / (options_.noise * options_.noise));
  for (int i = 0; i <= options_.iterations; ++i) {
    estimate.map_from_camera = pose.map_from_camera();
    const Rigid3 current_from_template = template_at(estimate.map_from_camera);
    estimate.sums = compare(points, current_from_template, gain);
    if (!(estimate.sums.normal(6, 6) > 0)) return estimate;
    // The points' motion xi in the template's frame is the camera's in its own.
    const Matrix6 to_template = current_from_template.inverse().adjoint();
    PoseEquations equations = estimate.sums.of_pose();
    equations.normal = to_template.transpose() *
                       Matrix6(equations.normal.selfadjointView<Eigen::Upper>()) * to_template;
    equations.rhs = to_template.transpose() * equations.rhs;
    estimate.information = pose.information(equations);
    // The last round is for the evidence.
    if (i == options_.iterations) break;
    if (!pose.step(equations)) return estimate;
    gain += estimate.sums.rhs(6) / estimate.sums.normal(6, 6);
  }
  estimate.is_valid = true;
  return estimate;
}

}  // namespace saccade
