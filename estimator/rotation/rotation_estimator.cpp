#include "estimator/rotation/rotation_estimator.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

constexpr std::size_t kFewEvents = 100;

}  // namespace

RotationEstimator::RotationEstimator(const PinholeCamera& camera, const RotationOptions& options)
    : options_(options),
      contrast_(camera, options.blur_px, static_cast<std::size_t>(options.samples)) {}

RotationEstimate RotationEstimator::estimate(std::span<const Event> events,
                                             const Eigen::Vector3d& guess) {
  contrast_.load(events);
  RotationEstimate result;
  result.t_s = contrast_.middle_s();
  result.rate = guess;
  if (events.size() < kFewEvents || !(contrast_.px_per_rate() > 0)) return result;
  // In pixels that an event moves on the average, so that all that is compared has one unit.
  const double px = contrast_.px_per_rate();
  Eigen::Vector3d at = guess;
  RotationContrast::Value value = contrast_.evaluate(at);
  // The curvature of the contrast is about -contrast / blur^2 per square pixel, less about the
  // viewing axis.
  const double scale = options_.blur_px * options_.blur_px / (px * px);
  Eigen::Matrix3d inverse = Eigen::Vector3d(scale, scale, 4 * scale).asDiagonal();
  inverse /= std::max(value.contrast, 1e-12);
  const double longest = 3 / px;  // [rad/s]
  for (result.iterations = 0; result.iterations < options_.iterations; ++result.iterations) {
    Eigen::Vector3d step = inverse * value.gradient;
    if (!(step.dot(value.gradient) > 0)) break;
    if (step.norm() > longest) step *= longest / step.norm();
    RotationContrast::Value next = contrast_.evaluate(at + step);
    for (int half = 0; half < 4 && !(next.contrast > value.contrast); ++half) {
      step /= 3;
      next = contrast_.evaluate(at + step);
    }
    if (!(next.contrast > value.contrast)) break;
    const Eigen::Vector3d change = value.gradient - next.gradient;
    const double product = step.dot(change);
    if (product > 0) {
      // BFGS of the negative contrast.
      const Eigen::Matrix3d part =
          Eigen::Matrix3d::Identity() - step * change.transpose() / product;
      inverse = part * inverse * part.transpose() + step * step.transpose() / product;
    }
    at += step;
    value = next;
    if (step.norm() * px < options_.tolerance_px) break;
  }
  result.rate = at;
  result.contrast = value.contrast;
  result.is_valid = at.allFinite();
  return result;
}

std::size_t next_window(std::span<const Event> events, const RotationOptions& options) {
  const std::size_t count = std::min(events.size(), static_cast<std::size_t>(options.events));
  if (count == 0) return 0;
  const TimeNs end_ns = events.front().t_ns + ns_from_seconds(options.max_window_s);
  const auto end =
      std::partition_point(events.begin(), events.begin() + static_cast<std::ptrdiff_t>(count),
                           [end_ns](const Event& e) { return e.t_ns < end_ns; });
  return static_cast<std::size_t>(end - events.begin());
}

}  // namespace saccade
