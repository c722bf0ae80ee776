#include "estimator/depth/thesis/thesis_depth.h"

#include <algorithm>
#include <cmath>

#include "core/stopwatch.h"
#include "core/time_search.h"
#include "estimator/depth/outlier_removal.h"
#include "estimator/depth/thesis/derotated_frame.h"
#include "estimator/depth/thesis/epipolar.h"
#include "estimator/depth/thesis/grid_keypoints.h"
#include "estimator/mean_time.h"

namespace saccade {

struct ThesisDepth::Keypoint {
  Eigen::Vector2d pixel;
  Eigen::Vector3d ray;
  FramePatch patch;
  DepthBelief belief;
};

namespace {

/// s of section 5.5: each cell gives at most one keypoint.
constexpr int kCell_px = 3;
/// Standard deviation of a match along the epipolar line: tau = kMatchSigma_px / |du/drho| of (5.14).
constexpr double kMatchSigma_px = 0.7;
/// A keypoint becomes a point only if a / (a + b) is above it.
constexpr double kMinInlierProbability = 0.5;

/// Beta prior (a, b) of a new keypoint: as many outliers as inliers are expected, with the weight of
/// 20 matches, so that the first few decide nothing alone.
constexpr double kPriorInliers = 10, kPriorOutliers = 10;

/// Least mean of a keypoint's cell over the mean of the frame: above the noise.
constexpr double kMinCellWeight = 0.3;

/// The events of each frame: first those around the reference time, then disjoint runs of the same
/// number on both sides, the nearest first. Empty where there are not enough events for two.
std::vector<std::span<const Event>> cut_frames(std::span<const Event> events, TimeNs reference_ns,
                                               std::size_t count) {
  if (events.size() < 2 * count) return {};
  const std::size_t index = count_before(events, reference_ns);
  const std::size_t first = std::min(index - std::min(index, count / 2), events.size() - count);
  std::vector<std::span<const Event>> frames;
  for (std::size_t begin = first % count; begin + count <= events.size(); begin += count)
    frames.push_back(events.subspan(begin, count));
  const TimeNs centre_ns = mean_time(events.subspan(first, count));
  std::stable_sort(frames.begin(), frames.end(), [&](const auto& a, const auto& b) {
    return std::abs(mean_time(a) - centre_ns) < std::abs(mean_time(b) - centre_ns);
  });
  return frames;
}

/// A point of the frame at `centre` [m, in the wanted view] in that view. The axes are the same, so
/// that z changes by centre.z alone and sigma of 1 / z scales with (z before / z after)^2.
EdgePoint moved(const PinholeCamera& camera, const Eigen::Vector3d& ray, const DepthBelief& belief,
                const Eigen::Vector3d& centre) {
  const Eigen::Vector3d point = ray / belief.mean + centre;
  const Eigen::Vector2f pixel = camera.project(point).cast<float>();
  const double ratio = 1 / (belief.mean * point.z());
  return {pixel.x(), pixel.y(), static_cast<float>(1 / point.z()),
          static_cast<float>(std::sqrt(belief.variance) * ratio * ratio)};
}

}  // namespace

void describe(config::Fields& fields, ThesisDepthOptions& options) {
  fields
      .value("events_per_px", options.events_per_px,
             "Events of one event frame, per pixel of the sensor (thesis section 5.4). Recordings "
             "with few events "
             "need small frames; large frames blur edges.")
      .range(0.001, 100);
  fields
      .value("max_sigma", options.max_sigma,
             "A keypoint has converged when the standard deviation of its inverse depth, divided "
             "by the inverse depth, is below this; larger values give more and less accurate "
             "points.")
      .above(0);
  fields
      .value("initial_depth_m", options.initial_depth_m,
             "Depth at which all keypoints start, in metres; ~ takes the dataset's mean scene "
             "depth.")
      .above(0);
}

ThesisDepth::ThesisDepth(const ThesisDepthOptions& options, const DepthLimits& limits,
                         const PinholeCamera& camera, double mean_depth_m)
    : options_(options),
      limits_(limits),
      camera_(camera.undistorted()),
      undistortion_(camera),
      initial_depth_m_(options.initial_depth_m.value_or(mean_depth_m)) {}

DepthResult ThesisDepth::estimate(const ViewWindow& window) const {
  double frame_s = 0, search_s = 0, removal_s = 0;
  DepthResult result;
  const Rigid3 reference_from_world = window.world_from_reference().inverse();
  const Derotation derotation(camera_, undistortion_, *window.trajectory,
                              reference_from_world.rotation().conjugate());
  const auto centre_of = [&](std::span<const Event> events) -> Eigen::Vector3d {
    const double t_s = seconds_from_ns(mean_time(events));
    return reference_from_world * window.trajectory->at_clamped(t_s).translation();
  };
  const auto draw = [&](std::span<const Event> events) {
    const ScopedTimer clock(frame_s);
    ImageF image = derotation.draw(events);  // (5.15)
    normalise_frame(image);
    return image;
  };

  const auto frames =
      cut_frames(window.events, ns_from_seconds(window.reference_s), events_per_frame());
  std::vector<Keypoint> keypoints;
  Eigen::Vector3d first_centre = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const ImageF frame = draw(frames[k]);
    const Eigen::Vector3d centre = centre_of(frames[k]) - first_centre;
    const ScopedTimer clock(search_s);
    if (k == 0) {
      first_centre = centre;
      keypoints = start_keypoints(frame);
    } else {
      for (Keypoint& keypoint : keypoints) update(frame, centre, keypoint);
    }
  }

  std::vector<EdgePoint> converged;
  for (const Keypoint& keypoint : keypoints) {
    const EdgePoint point = moved(camera_, keypoint.ray, keypoint.belief, first_centre);
    result.candidates.emplace_back(point.x_px, point.y_px);
    if (is_converged(keypoint.belief) && point.inverse_depth > 0) converged.push_back(point);
  }
  {
    const ScopedTimer clock(removal_s);
    result.points = without_outliers(converged, camera_);
  }
  result.stages_s = {{"event_frame", frame_s}, {"search", search_s}, {"outliers", removal_s}};
  return result;
}

std::size_t ThesisDepth::events_per_frame() const {
  const double events = options_.events_per_px * camera_.width * camera_.height;
  return static_cast<std::size_t>(std::max(1.0, std::round(events)));
}

std::vector<ThesisDepth::Keypoint> ThesisDepth::start_keypoints(const ImageF& reference) const {
  const double range = limits_.max_inverse() - limits_.min_inverse();
  // Six standard deviations span the range of inverse depths.
  const DepthBelief prior{1 / initial_depth_m_, range * range / 36, kPriorInliers, kPriorOutliers};
  std::vector<Keypoint> keypoints;
  for (const Eigen::Vector2f& centre : find_keypoints(reference, kCell_px, kMinCellWeight)) {
    const Eigen::Vector2d pixel = centre.cast<double>();
    const int radius = SearchOptions().patch_radius_px;
    if (!FramePatch::fits(reference, pixel, radius)) continue;
    keypoints.push_back({pixel, camera_.ray(pixel), FramePatch(reference, pixel, radius), prior});
  }
  return keypoints;
}

void ThesisDepth::update(const ImageF& frame, const Eigen::Vector3d& centre,
                         Keypoint& keypoint) const {
  const EpipolarLine line(camera_, keypoint.ray, centre);
  if (!line.is_in_front(keypoint.belief.mean)) return;
  const Eigen::Vector2d start = line.pixel(keypoint.belief.mean);  // u_init of (5.3)
  const Eigen::Vector2d per_inverse_depth = line.derivative(keypoint.belief.mean);
  const double length = per_inverse_depth.norm();
  if (!(length > 0)) return;
  const Eigen::Vector2d direction = per_inverse_depth / length;
  const SearchResult match = search_along(keypoint.patch, frame, start, direction, SearchOptions());
  if (match.status != SearchStatus::kFound) return;
  const Eigen::Vector2d matched = start + match.shift_px * direction;  // W(u; p) of (5.2)
  const double inverse_depth =
      triangulate(keypoint.ray, camera_.ray(matched), centre);  // (5.12), (5.13)
  if (!std::isfinite(inverse_depth)) return;
  const double tau = kMatchSigma_px / length;
  const double range = limits_.max_inverse() - limits_.min_inverse();
  keypoint.belief = updated(keypoint.belief, inverse_depth, tau * tau, range);  // (5.14)
  keypoint.belief.mean =
      std::clamp(keypoint.belief.mean, limits_.min_inverse(), limits_.max_inverse());
}

bool ThesisDepth::is_converged(const DepthBelief& belief) const {
  const double limit = options_.max_sigma * belief.mean;
  return belief.variance < limit * limit && belief.inlier_probability() > kMinInlierProbability;
}

}  // namespace saccade
