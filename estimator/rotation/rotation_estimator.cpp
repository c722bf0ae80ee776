#include "estimator/rotation/rotation_estimator.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

constexpr double kLongest_px = 3;  ///< of a step

}  // namespace

RotationEstimator::RotationEstimator(const PinholeCamera& camera, const RotationOptions& options)
    : options_(options),
      contrast_(camera, options.blur_px, options.burst_share,
                static_cast<std::size_t>(options.samples)) {}

RotationEstimate RotationEstimator::estimate(std::span<const Event> events, const Turning& guess) {
  using Parameters = RotationContrast::Parameters;
  using Square = Eigen::Matrix<double, 6, 6>;
  contrast_.load(events);
  RotationEstimate result;
  result.t_s = contrast_.middle_s();
  result.turning = guess;
  result.px_per_rate = contrast_.px_per_rate();
  if (events.size() < static_cast<std::size_t>(options_.min_events) ||
      !(contrast_.px_per_acceleration() > 0))
    return result;
  // In pixels that an event moves, RMS, so that all that is compared has one unit.
  Parameters px;
  px << Eigen::Vector3d::Constant(contrast_.px_per_rate()),
      Eigen::Vector3d::Constant(contrast_.px_per_acceleration());
  Parameters at = contrast_.parameters_of(guess).cwiseProduct(px);
  const auto evaluate = [&](const Parameters& place) {
    RotationContrast::Value value = contrast_.evaluate(place.cwiseQuotient(px));
    value.gradient = value.gradient.cwiseQuotient(px).eval();
    return value;
  };
  RotationContrast::Value value = evaluate(at);
  // Nothing is lost by a guess that is worse than none.
  if (const RotationContrast::Value still = evaluate(Parameters::Zero());
      still.contrast > value.contrast) {
    at.setZero();
    value = still;
  }
  // The curvature of the contrast is about -contrast / (5 blur^2), less about the viewing axis.
  const double scale = 5 * options_.blur_px * options_.blur_px / std::max(value.contrast, 1e-12);
  Parameters diagonal;
  diagonal << scale, scale, 4 * scale, scale, scale, 4 * scale;
  Square inverse = diagonal.asDiagonal();
  for (result.iterations = 0; result.iterations < options_.iterations; ++result.iterations) {
    Parameters step = inverse * value.gradient;
    if (!(step.dot(value.gradient) > 0)) break;
    if (step.norm() > kLongest_px) step *= kLongest_px / step.norm();
    RotationContrast::Value next = evaluate(at + step);
    for (int half = 0; half < 4 && !(next.contrast > value.contrast); ++half) {
      step /= 3;
      next = evaluate(at + step);
    }
    if (!(next.contrast > value.contrast)) break;
    const Parameters change = value.gradient - next.gradient;
    const double product = step.dot(change);
    if (product > 0) {
      // BFGS of the negative contrast.
      const Square part = Square::Identity() - step * change.transpose() / product;
      inverse = part * inverse * part.transpose() + step * step.transpose() / product;
    }
    at += step;
    value = next;
    if (step.norm() < options_.tolerance_px) break;
  }
  result.turning = contrast_.turning_of(at.cwiseQuotient(px));
  result.contrast = value.contrast;
  result.is_valid = at.allFinite();
  return result;
}

Turning RotationEstimator::predict(const RotationEstimate& last, double t_s) {
  // Of a window that said nothing, the rate may still be right, but not how it changed.
  if (!last.is_valid) return {last.turning.rate, Eigen::Vector3d::Zero()};
  return {last.turning.rate + (t_s - last.t_s) * last.turning.acceleration,
          last.turning.acceleration};
}

std::size_t next_window(std::span<const Event> events, const RotationOptions& options) {
  const auto whole = static_cast<std::size_t>(options.events);
  const std::size_t count = events.size() < whole + whole / 2 ? events.size() : whole;
  if (count == 0) return 0;
  const TimeNs end_ns = events.front().t_ns + ns_from_seconds(options.max_window_s);
  const auto end =
      std::partition_point(events.begin(), events.begin() + static_cast<std::ptrdiff_t>(count),
                           [end_ns](const Event& e) { return e.t_ns < end_ns; });
  return static_cast<std::size_t>(end - events.begin());
}

}  // namespace saccade
