#include "estimator/tracking/frames/frame_tracker.h"

#include <algorithm>
#include <cmath>

#include "core/stopwatch.h"
#include "estimator/tracking/robust_loss.h"

namespace saccade {
namespace {

/// With less of the map in the image the camera has left it.
constexpr double kMinVisible = 0.02;
/// Most pixels of a frame that are compared, spread evenly.
constexpr std::size_t kSamples = 10000;
/// Between two frames the image moves by many pixels: means over 16 x 16 pixels come first.
constexpr int kPyramidLevels = 5;
/// Gauss-Newton steps on each level; fewer suffice for slow motion.
constexpr int kIterations = 12;
/// sigma of a pixel [log units] and of its reprojection: the map consists of point samples.
constexpr double kSigma = 0.05;
constexpr double kPositionSigma_px = 0.3;
/// Neighbouring residuals err alike: their information counts by this fraction.
constexpr double kInformation = 0.1;
/// Lost with a smaller fraction of inliers.
constexpr double kMinInlierRatio = 0.7;

}  // namespace

/// The normal equations of one step, with their evidence.
struct FrameTracker::Sums : PoseEquations {
  double visible = 0;  ///< pixels that are compared
  double inliers = 0;  ///< of them those within the tail
  double squared = 0;  ///< sum of their squared residuals
};

FrameTracker::FrameTracker(const MotionModelOptions& motion, const IntensityMap& map)
    : Tracker(motion, map.camera().fx, map.world_from_map()),
      map_(map),
      view_(map, 0),
      rendered_(map.camera().width, map.camera().height) {}

void FrameTracker::reset(TimeNs t_ns, const Rigid3& world_from_camera) {
  motion_.reset(t_ns, world_from_map_.inverse() * world_from_camera);
  view_.draw(motion_.pose());
  timing_ = {};
}

std::vector<TrackedPose> FrameTracker::track(const Recording& recording,
                                             const TrackProgress& progress) {
  std::vector<TrackedPose> poses;
  for (const GreyFrame& frame : recording.frames) {
    poses.push_back(track_frame(frame));
    if (progress) progress(1);
  }
  return poses;
}

TrackedPose FrameTracker::track_frame(const GreyFrame& frame) {
  TrackedPose pose;
  pose.t_ns = pose.first_ns = pose.last_ns = frame.t_ns;
  const PosePrediction predicted = motion_.predict(frame.t_ns, view_.typical_depth_m());
  const PoseEstimate<Sums> estimate = align(frame, predicted);
  const Sums& sums = estimate.sums;
  pose.inlier_ratio = sums.visible > 0 ? sums.inliers / sums.visible : 0;
  pose.residual = sums.inliers > 0 ? std::sqrt(sums.squared / sums.inliers) : 0;
  pose.iterations = (coarsest_level() + 1) * kIterations;
  if (estimate.is_valid && pose.inlier_ratio >= kMinInlierRatio) {
    motion_.update(estimate.map_from_camera, estimate.information);
  } else {
    motion_.stop();
    pose.status = TrackStatus::kLost;
  }
  write_pose(pose);
  return pose;
}

auto FrameTracker::align(const GreyFrame& frame, const PosePrediction& predicted)
    -> PoseEstimate<Sums> {
  PoseSolver pose(predicted, kInformation / (kSigma * kSigma));
  PoseEstimate<Sums> estimate;
  for (int level = coarsest_level(); level >= 0; --level)
    // The last round of all is for the evidence.
    for (int i = 0; i < kIterations + (level == 0 ? 1 : 0); ++i) {
      estimate.map_from_camera = pose.map_from_camera();
      draw(estimate.map_from_camera);
      estimate.sums = compare(frame.log_intensity, 1 << level);
      if (i < kIterations && !pose.step(estimate.sums)) return estimate;
    }
  const double pixels = std::min<double>(kSamples, static_cast<double>(rendered_.size()));
  estimate.information = pose.information(estimate.sums);
  estimate.is_valid = estimate.sums.visible > kMinVisible * pixels;
  return estimate;
}

int FrameTracker::coarsest_level() const {
  constexpr int kLeastPixels = 6;
  int level = kPyramidLevels - 1;
  while (level > 0 && (std::min(rendered_.width(), rendered_.height()) >> level) < kLeastPixels)
    --level;
  return level;
}

void FrameTracker::draw(const Rigid3& map_from_camera) {
  const ScopedTimer clock(timing_.view_s);
  view_.draw(map_from_camera);
  for (int y = 0; y < rendered_.height(); ++y)
    for (int x = 0; x < rendered_.width(); ++x) {
      const MapSample& at = view_(x, y);
      const bool is_visible =
          at.inverse_depth > 0 && is_inside(map_.atlas(), at.atlas_px.x(), at.atlas_px.y());
      rendered_(x, y) = is_visible ? sample(map_.atlas(), at.atlas_px.x(), at.atlas_px.y())
                                   : kUnknownLogIntensity;
    }
}

void FrameTracker::average(const ImageF& frame, int square_px) {
  const int width = frame.width() / square_px;
  const int height = frame.height() / square_px;
  mean_frame_ = ImageF(width, height, kUnknownLogIntensity);
  mean_map_ = ImageF(width, height, kUnknownLogIntensity);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      float in_frame = 0;
      float in_map = 0;
      int known = 0;
      for (int v = y * square_px; v < (y + 1) * square_px; ++v)
        for (int u = x * square_px; u < (x + 1) * square_px; ++u) {
          if (!std::isfinite(frame(u, v)) || !std::isfinite(rendered_(u, v))) continue;
          in_frame += frame(u, v);
          in_map += rendered_(u, v);
          ++known;
        }
      if (2 * known < square_px * square_px) continue;
      mean_frame_(x, y) = in_frame / static_cast<float>(known);
      mean_map_(x, y) = in_map / static_cast<float>(known);
    }
}

auto FrameTracker::compare(const ImageF& frame, int square_px) -> Sums {
  const ScopedTimer clock(timing_.align_s);
  average(frame, square_px);
  Sums sums;
  const double area = static_cast<double>(mean_map_.size());
  const auto count = std::min(kSamples, mean_map_.size());
  const double stride = area / static_cast<double>(std::max<std::size_t>(count, 1));
  for (std::size_t k = 0; k < count; ++k) {
    const auto i = static_cast<int>(static_cast<double>(k) * stride);
    const int x = i % mean_map_.width();
    const int y = i / mean_map_.width();
    if (x > 0 && y > 0 && x + 1 < mean_map_.width() && y + 1 < mean_map_.height())
      add_pixel(x, y, square_px, sums);
  }
  return sums;
}

void FrameTracker::add_pixel(int x, int y, int square_px, Sums& sums) const {
  const ImageF& map = mean_map_;
  const double residual = static_cast<double>(mean_frame_(x, y) - map(x, y));
  const Eigen::RowVector2d slope =
      Eigen::RowVector2d(static_cast<double>(map(x + 1, y) - map(x - 1, y)),
                         static_cast<double>(map(x, y + 1) - map(x, y - 1))) /
      (2 * square_px);
  if (!std::isfinite(residual) || !slope.allFinite()) return;
  const double middle = 0.5 * (square_px - 1);
  const Eigen::Vector2d pixel(x * square_px + middle, y * square_px + middle);
  const MapSample& at = view_(static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
  if (!(at.inverse_depth > 0)) return;
  const double variance =
      kSigma * kSigma + kPositionSigma_px * kPositionSigma_px * slope.squaredNorm();
  const double relative = residual * residual / (variance * kCauchyScale * kCauchyScale);
  const double weight = kSigma * kSigma / (variance * (1 + relative));
  const PinholeCamera& camera = map_.camera();
  const Twist row = (slope * interaction_matrix(camera, camera.ray(pixel),
                                                1 / static_cast<double>(at.inverse_depth)))
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
