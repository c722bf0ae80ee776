#include "estimator/tracking/polarity/polarity_tracker.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/stopwatch.h"
#include "estimator/mean_time.h"

namespace saccade {
namespace {

/// Gauss-Newton steps of a pose, always all of them.
constexpr int kIterations = 4;
/// Slope of the increments that are compared, relative to the root mean square of all: where they
/// are flat they say nothing about the pose.
constexpr double kMinSlope = 1;
/// The map is rendered anew when the view has moved this far.
constexpr double kRedraw_px = 4;
/// Neighbouring residuals err alike: their information counts by this fraction.
constexpr double kInformation = 0.01;
/// With a smaller agreement of signs the edges take over; 0.5 is chance.
constexpr double kMinAgreement = 0.8;

}  // namespace

void describe(config::Fields& fields, PolarityOptions& options) {
  fields
      .value("events", options.events,
             "Events that make a pose. More of them average out more noise; fewer follow faster "
             "changes of the motion.")
      .range(1, 1e6);
  fields.value("reversals", options.reversals,
               "Whether an event of the other polarity than its pixel's last one counts twice, as "
               "two thresholds were crossed. Without it the poses lag behind the motion.");
}

PolarityTracker::PolarityTracker(const PolarityOptions& options, const MotionModelOptions& motion,
                                 const PinholeCamera& camera, const IntensityMap& map,
                                 EdgeTracker edges)
    : Tracker(motion, camera.fx, map.world_from_map()),
      options_(options),
      camera_(camera.undistorted()),
      map_(map),
      view_(map, 0),
      template_(camera_),
      frame_(camera, options.reversals),
      fallback_(std::move(edges)) {}

void PolarityTracker::reset(TimeNs t_ns, const Rigid3& world_from_camera) {
  motion_.reset(t_ns, world_from_map_.inverse() * world_from_camera);
  fallback_.reset(t_ns, world_from_camera);
  frame_.reset();
  has_view_ = false;
  by_edges_ = true;
  views_drawn_ = 0;
  timing_ = {};
}

std::vector<TrackedPose> PolarityTracker::track(const Recording& recording,
                                                const TrackProgress& progress) {
  Poses poses;
  Recording rest = recording;
  const auto count = static_cast<std::size_t>(options_.events);
  while (rest.events.size() >= count) {
    std::size_t done = count;
    if (by_edges_ || !track_frame(rest.events.first(count), poses)) {
      by_edges_ = true;  // also where they have to wait
      done = follow_edges(rest, poses);
      if (done == 0) break;  // too few events are left
    }
    rest.events = rest.events.subspan(done);
    if (progress) progress(done);
  }
  return poses;
}

std::size_t PolarityTracker::follow_edges(const Recording& recording, Poses& poses) {
  const std::size_t done = fallback_.follow(recording, poses, timing_);
  if (done == 0) return 0;
  by_edges_ = !fallback_.fits();
  motion_ = fallback_.motion();
  frame_.reset();
  draw_view(motion_.pose());
  return done;
}

void PolarityTracker::draw_view(const Rigid3& map_from_camera) {
  const ScopedTimer clock(timing_.view_s);
  if (has_view_ && view_.moved_px(map_from_camera) < kRedraw_px) return;
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
    const ScopedTimer clock(timing_.load_s);
    frame_.draw(events, pose.t_ns, ImageMotion(camera_, motion_.velocity()), view_);
  }
  const PoseEstimate<Sums> estimate = align(predicted);
  const Sums& sums = estimate.sums;
  pose.inlier_ratio = sums.agreement();
  if (!estimate.is_valid || pose.inlier_ratio < kMinAgreement) {
    fallback_.reset_near(pose.first_ns, world_from_map_ * last);
    return false;
  }
  motion_.update(estimate.map_from_camera, estimate.information);
  pose.iterations = kIterations;
  pose.residual = sums.weight > 0 ? std::sqrt(sums.squares / sums.weight) : 0;
  write_pose(pose);
  poses.push_back(pose);
  return true;
}

auto PolarityTracker::compare(const IncrementPoints& points, const Rigid3& current_from_template,
                              double gain) -> Sums {
  Sums sums;
  for (std::size_t first = 0; first < points.count; first += IncrementResidualBatch::kCapacity) {
    batch_.evaluate(camera_, frame_.image(), points, first, current_from_template, gain);
    batch_.add_to(sums);
  }
  return sums;
}

auto PolarityTracker::align(const PosePrediction& predicted) -> PoseEstimate<Sums> {
  const ScopedTimer clock(timing_.align_s);
  const auto template_at = [&](const Rigid3& map_from_camera) {
    return map_from_camera.inverse() * view_.map_from_camera();
  };
  const Rigid3 start = template_at(predicted.map_from_camera);
  const IncrementPoints& points =
      template_.points(start.inverse().adjoint() * motion_.velocity(), kMinSlope);
  PoseEstimate<Sums> estimate;
  estimate.sums = compare(points, start, 0);
  if (!(estimate.sums.product > 0)) return estimate;
  double gain = estimate.sums.product / estimate.sums.expected;
  constexpr double kSigma = 0.2;
  PoseSolver pose(predicted, kInformation / (kSigma * kSigma));
  for (int i = 0; i <= kIterations; ++i) {
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
    if (i == kIterations) break;
    if (!pose.step(equations)) return estimate;
    gain += estimate.sums.rhs(6) / estimate.sums.normal(6, 6);
  }
  estimate.is_valid = true;
  return estimate;
}

}  // namespace saccade
