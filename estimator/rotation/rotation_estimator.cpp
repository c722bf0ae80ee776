#include "estimator/rotation/rotation_estimator.h"

#include <Eigen/LU>

#include <algorithm>

#include "core/time_search.h"

namespace saccade {
namespace {

constexpr double kMaxStep_px = 3;
// A step of less than a hundredth of a pixel changes the rate by less than its noise.
constexpr int kMaxIterations = 30;
constexpr double kTolerance_px = 0.01;

}  // namespace

RotationEstimator::RotationEstimator(const PinholeCamera& camera, const RotationOptions& options)
    : options_(options),
      contrast_(camera, options.blur_px, options.burst_fraction,
                static_cast<std::size_t>(options.samples)) {}

RotationEstimate RotationEstimator::estimate(std::span<const Event> events,
                                             const AngularMotion& guess) {
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
  // The parameters are scaled to pixels of event motion, RMS, so that they have one unit.
  Parameters px;
  px << Eigen::Vector3d::Constant(contrast_.px_per_rate()),
      Eigen::Vector3d::Constant(contrast_.px_per_acceleration());
  Parameters at = contrast_.to_parameters(guess).cwiseProduct(px);
  const auto evaluate = [&](const Parameters& p) {
    RotationContrast::Value value = contrast_.evaluate(p.cwiseQuotient(px));
    value.gradient = value.gradient.cwiseQuotient(px).eval();
    return value;
  };
  RotationContrast::Value value = evaluate(at);
  // A guess that is worse than no motion is discarded.
  if (const RotationContrast::Value at_rest = evaluate(Parameters::Zero());
      at_rest.contrast > value.contrast) {
    at.setZero();
    value = at_rest;
  }
  // Initial inverse Hessian: the curvature is about -contrast / (5 blur^2), a quarter of it about
  // the viewing axis.
  const double scale = 5 * options_.blur_px * options_.blur_px / std::max(value.contrast, 1e-12);
  Parameters diagonal;
  diagonal << scale, scale, 4 * scale, scale, scale, 4 * scale;
  Square inverse = diagonal.asDiagonal();
  for (result.iterations = 0; result.iterations < kMaxIterations; ++result.iterations) {
    Parameters step = inverse * value.gradient;
    if (!(step.dot(value.gradient) > 0)) break;
    if (step.norm() > kMaxStep_px) step *= kMaxStep_px / step.norm();
    RotationContrast::Value next = evaluate(at + step);
    for (int half = 0; half < 4 && !(next.contrast > value.contrast); ++half) {
      step /= 3;
      next = evaluate(at + step);
    }
    if (!(next.contrast > value.contrast)) break;
    const Parameters y = value.gradient - next.gradient;
    const double curvature = step.dot(y);
    if (curvature > 0) {
      // BFGS update for the negative contrast.
      const Square v = Square::Identity() - step * y.transpose() / curvature;
      inverse = v * inverse * v.transpose() + step * step.transpose() / curvature;
    }
    at += step;
    value = next;
    if (step.norm() < kTolerance_px) break;
  }
  result.turning = contrast_.to_motion(at.cwiseQuotient(px));
  result.contrast = value.contrast;
  result.is_valid = at.allFinite();
  return result;
}

AngularMotion RotationEstimator::predict(const RotationEstimate& last, double t_s) {
  // Without an estimate the rate is kept, but not the acceleration.
  if (!last.is_valid) return {last.turning.rate, Eigen::Vector3d::Zero()};
  return {last.turning.rate + (t_s - last.t_s) * last.turning.acceleration,
          last.turning.acceleration};
}

std::size_t next_window_size(std::span<const Event> events, const RotationOptions& options) {
  const auto whole = static_cast<std::size_t>(options.window_events);
  const std::size_t count = events.size() < whole + whole / 2 ? events.size() : whole;
  if (count == 0) return 0;
  const TimeNs end_ns = events.front().t_ns + ns_from_seconds(options.max_window_s);
  return count_before(events.first(count), end_ns);
}

}  // namespace saccade
