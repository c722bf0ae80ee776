#include "estimator/rotation/rotation_estimator.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

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
      contrast_(camera, options.blur_px, options.bursts,
                static_cast<std::size_t>(options.samples)) {}

RotationEstimate RotationEstimator::estimate(std::span<const Event> events,
                                             const AngularMotion& guess) {
  using Parameters = RotationContrast::Parameters;
  using Square = Eigen::Matrix<double, 6, 6>;
  contrast_.load(events);
  RotationEstimate result;
  result.t_s = contrast_.reference_s();
  result.turning = {guess.rate + (result.t_s - contrast_.middle_s()) * guess.acceleration,
                    guess.acceleration};
  result.px_per_rate = contrast_.px_per_rate();
  if (events.size() < static_cast<std::size_t>(options_.min_events) ||
      !(contrast_.px_per_acceleration() > 0))
    return result;
  // The parameters are scaled to pixels of event motion, RMS, so that they have one unit.
  Parameters px;
  px << Eigen::Vector3d::Constant(contrast_.px_per_rate()),
      Eigen::Vector3d::Constant(contrast_.px_per_acceleration());
  Parameters at;
  at << result.turning.rate, result.turning.acceleration;
  at = at.cwiseProduct(px).eval();
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
  at = at.cwiseQuotient(px).eval();
  result.turning = {at.head<3>(), at.tail<3>()};
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

double window_duration(const PinholeCamera& camera, const Eigen::Vector3d& rate,
                       const RotationOptions& options) {
  // About the viewing axis a pixel moves by its distance from it, whose mean square is that of a
  // rectangle.
  const double about_axis =
      rate.z() * rate.z() * (camera.width * camera.width + camera.height * camera.height) / 12.0;
  const double across = camera.fx * camera.fx * (rate.x() * rate.x() + rate.y() * rate.y());
  const double speed_px = std::sqrt(across + about_axis);
  return std::clamp(options.window_motion_px / std::max(speed_px, 1e-9), options.min_window_s,
                    options.max_window_s);
}

std::size_t next_window_size(std::span<const Event> events, double duration_s,
                             const RotationOptions& options) {
  const auto whole = static_cast<std::size_t>(options.window_events);
  const std::size_t count = events.size() < whole + whole / 2 ? events.size() : whole;
  if (count == 0) return 0;
  // What is left after a window may be too short for one of its own.
  const double left_s = seconds_from_ns(events[count - 1].t_ns - events.front().t_ns);
  if (count == events.size() && left_s < 1.5 * duration_s) return count;
  const TimeNs end_ns = events.front().t_ns + ns_from_seconds(duration_s);
  return count_before(events.first(count), end_ns);
}

std::size_t window_step(std::span<const Event> window) {
  if (window.empty()) return 0;
  const double duration_s = seconds_from_ns(window.back().t_ns - window.front().t_ns);
  const TimeNs next_ns = window.front().t_ns + ns_from_seconds(std::sqrt(0.6) * duration_s);
  return std::max<std::size_t>(1, count_before(window, next_ns));
}

}  // namespace saccade
