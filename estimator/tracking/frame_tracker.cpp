#include "estimator/tracking/frame_tracker.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/stopwatch.h"
#include "estimator/tracking/posterior_pose.h"
#include "estimator/tracking/robust_weight.h"

namespace saccade {
namespace {

/// What less of the picture shows the map has been left behind.
constexpr double kLeastSeen = 0.02;

}  // namespace

/// The normal equations of one step, with their evidence.
struct FrameTracker::Sums : PoseEquations {
  double visible = 0;  ///< pixels that are compared
  double inliers = 0;  ///< of them those within the tail
  double squared = 0;  ///< sum of their squared residuals
};

/// The outcome of one alignment.
struct FrameTracker::Estimate {
  Rigid3 map_from_camera;
  Matrix6 information = Matrix6::Zero();
  Sums sums;
  bool is_valid = false;
};

FrameTracker::FrameTracker(const FrameTrackOptions& options, const PredictionOptions& motion,
                           const IntensityMap& map)
    : options_(options),
      map_(map),
      view_(map, 0),
      shown_(map.camera().width, map.camera().height),
      motion_(motion, map.camera().fx) {}

void FrameTracker::reset(TimeNs t_ns, const Rigid3& world_from_camera) {
  motion_.reset(t_ns, map_.world_from_map().inverse() * world_from_camera);
  view_.draw(motion_.pose());
  timing_ = {};
}

std::vector<TrackedPose> FrameTracker::track(std::span<const GreyFrame> frames,
                                             const std::function<void(std::size_t)>& progress) {
  std::vector<TrackedPose> poses;
  for (const GreyFrame& frame : frames) {
    poses.push_back(track_frame(frame));
    if (progress) progress(1);
  }
  return poses;
}

TrackedPose FrameTracker::track_frame(const GreyFrame& frame) {
  TrackedPose pose;
  pose.t_ns = pose.first_ns = pose.last_ns = frame.t_ns;
  const PosePrediction predicted = motion_.predict(frame.t_ns, view_.typical_depth_m());
  const Estimate estimate = align(frame, predicted);
  const Sums& sums = estimate.sums;
  pose.inlier_ratio = sums.visible > 0 ? sums.inliers / sums.visible : 0;
  pose.residual = sums.inliers > 0 ? std::sqrt(sums.squared / sums.inliers) : 0;
  pose.iterations = (coarsest_level() + 1) * options_.iterations;
  if (estimate.is_valid && pose.inlier_ratio >= options_.min_inliers) {
    motion_.update(estimate.map_from_camera, estimate.information);
  } else {
    motion_.stop();
    pose.status = TrackStatus::kLost;
  }
  pose.world_from_camera = map_.world_from_map() * motion_.pose();
  pose.set_sigmas(motion_.covariance());
  return pose;
}

auto FrameTracker::align(const GreyFrame& frame, const PosePrediction& predicted) -> Estimate {
  PosteriorPose pose(predicted, options_.information / (options_.noise * options_.noise));
  Estimate estimate;
  for (int level = coarsest_level(); level >= 0; --level)
    // The last round of all is for the evidence.
    for (int i = 0; i < options_.iterations + (level == 0 ? 1 : 0); ++i) {
      estimate.map_from_camera = pose.map_from_camera();
      draw(estimate.map_from_camera);
      estimate.sums = compare(frame.log_intensity, 1 << level);
      if (i < options_.iterations && !pose.step(estimate.sums)) return estimate;
    }
  const double pixels = std::min<double>(options_.samples, static_cast<double>(shown_.size()));
  estimate.information = pose.information(estimate.sums);
  estimate.is_valid = estimate.sums.visible > kLeastSeen * pixels;
  return estimate;
}

int FrameTracker::coarsest_level() const {
  constexpr int kLeastPixels = 6;
  int level = options_.levels - 1;
  while (level > 0 && (std::min(shown_.width(), shown_.height()) >> level) < kLeastPixels) --level;
  return level;
}

void FrameTracker::draw(const Rigid3& map_from_camera) {
  const ScopedTimer clock(timing_.template_s);
  view_.draw(map_from_camera);
  for (int y = 0; y < shown_.height(); ++y)
    for (int x = 0; x < shown_.width(); ++x) {
      const SeenPlace& seen = view_(x, y);
      const bool is_seen =
          seen.inverse_depth > 0 && is_inside(map_.atlas(), seen.place.x(), seen.place.y());
      shown_(x, y) = is_seen ? sample(map_.atlas(), seen.place.x(), seen.place.y()) : kUnknownLevel;
    }
}

void FrameTracker::average(const ImageF& frame, int square_px) {
  const int width = frame.width() / square_px;
  const int height = frame.height() / square_px;
  pictures_ = {square_px, ImageF(width, height, kUnknownLevel),
               ImageF(width, height, kUnknownLevel)};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      float in_frame = 0;
      float in_map = 0;
      int known = 0;
      for (int v = y * square_px; v < (y + 1) * square_px; ++v)
        for (int u = x * square_px; u < (x + 1) * square_px; ++u) {
          if (!std::isfinite(frame(u, v)) || !std::isfinite(shown_(u, v))) continue;
          in_frame += frame(u, v);
          in_map += shown_(u, v);
          ++known;
        }
      if (2 * known < square_px * square_px) continue;
      pictures_.frame(x, y) = in_frame / static_cast<float>(known);
      pictures_.map(x, y) = in_map / static_cast<float>(known);
    }
}

auto FrameTracker::compare(const ImageF& frame, int square_px) -> Sums {
  const ScopedTimer clock(timing_.align_s);
  average(frame, square_px);
  Sums sums;
  const ImageF& picture = pictures_.map;
  const double area = static_cast<double>(picture.size());
  const auto count = std::min(static_cast<std::size_t>(options_.samples), picture.size());
  const double stride = area / static_cast<double>(std::max<std::size_t>(count, 1));
  for (std::size_t k = 0; k < count; ++k) {
    const auto i = static_cast<int>(static_cast<double>(k) * stride);
    const int x = i % picture.width();
    const int y = i / picture.width();
    if (x > 0 && y > 0 && x + 1 < picture.width() && y + 1 < picture.height())
      add_pixel(x, y, sums);
  }
  return sums;
}

void FrameTracker::add_pixel(int x, int y, Sums& sums) const {
  const ImageF& map = pictures_.map;
  const double residual = static_cast<double>(pictures_.frame(x, y) - map(x, y));
  const Eigen::RowVector2d slope =
      Eigen::RowVector2d(static_cast<double>(map(x + 1, y) - map(x - 1, y)),
                         static_cast<double>(map(x, y + 1) - map(x, y - 1))) /
      (2 * pictures_.square_px);
  if (!std::isfinite(residual) || !slope.allFinite()) return;
  const double middle = 0.5 * (pictures_.square_px - 1);
  const Eigen::Vector2d pixel(x * pictures_.square_px + middle, y * pictures_.square_px + middle);
  const SeenPlace& seen = view_(static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
  if (!(seen.inverse_depth > 0)) return;
  const double variance =
      options_.noise * options_.noise + options_.place_px * options_.place_px * slope.squaredNorm();
  const double relative = residual * residual / (variance * kCauchyScale * kCauchyScale);
  const double weight = options_.noise * options_.noise / (variance * (1 + relative));
  const PinholeCamera& camera = map_.camera();
  const Twist row = (slope * interaction_matrix(camera, camera.ray(pixel),
                                                1 / static_cast<double>(seen.inverse_depth)))
                        .transpose();
  sums.normal += weight * row * row.transpose();
  sums.rhs += weight * residual * row;
  sums.visible += 1;
  if (relative < 1) {
    sums.inliers += 1;
    sums.squared += residual * residual;
  }
}

}  // namespace saccade
