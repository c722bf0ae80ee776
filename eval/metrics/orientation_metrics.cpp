#include "eval/metrics/orientation_metrics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/time_search.h"

namespace saccade {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// The last estimate of the first stretch at rest; null where there was none, or no other.
const GyroBiasEstimate* end_of_rest(const std::vector<GyroBiasEstimate>& biases) {
  const auto at_rest = [](const GyroBiasEstimate& one) { return one.at_rest; };
  const auto begin = std::find_if(biases.begin(), biases.end(), at_rest);
  if (begin == biases.end()) return nullptr;
  const auto end = std::find_if_not(begin, biases.end(), at_rest);
  return &*(end - 1);
}

/// Slope of the heading's error over time by least squares [rad/s].
std::optional<double> heading_slope(std::span<const OrientationError> errors) {
  if (errors.size() < 2) return std::nullopt;
  double mean_t = 0, mean = 0;
  for (const OrientationError& e : errors) {
    mean_t += e.t_s / static_cast<double>(errors.size());
    mean += e.heading_rad / static_cast<double>(errors.size());
  }
  double product = 0, square = 0;
  for (const OrientationError& e : errors) {
    product += (e.t_s - mean_t) * (e.heading_rad - mean);
    square += (e.t_s - mean_t) * (e.t_s - mean_t);
  }
  if (!(square > 0)) return std::nullopt;
  return product / square;
}

void score_bias(const GyroBiasEstimate& estimate, const std::vector<ImuTruth>& truth,
                Metrics& metrics) {
  metrics.set("orientation.bias_sigma_rad_s", estimate.sigma);
  const std::size_t until =
      count_until(truth, estimate.t_ns, [](const ImuTruth& one) { return one.ideal.t_ns; });
  if (until == 0) return;
  const Eigen::Vector3d error = estimate.bias - truth[until - 1].gyro_bias;
  metrics.set("orientation.bias_error_rad_s", error.norm() / std::sqrt(3));
}

}  // namespace

std::vector<OrientationError> orientation_errors(const Trajectory& estimate,
                                                 const Trajectory& truth) {
  std::vector<OrientationError> errors;
  if (truth.empty()) return errors;
  double start = 0;
  for (const StampedPose& pose : estimate.poses()) {
    const auto true_pose = truth.at(pose.t_s);
    if (!true_pose) continue;
    const Eigen::Quaterniond d =
        pose.world_from_camera.rotation() * true_pose->rotation().conjugate();
    const Eigen::Vector3d up = d * Eigen::Vector3d::UnitZ();
    double heading = 2 * std::atan2(d.z(), d.w());
    if (errors.empty()) start = heading;
    heading -= start;
    const double last = errors.empty() ? 0 : errors.back().heading_rad;
    heading += 2 * std::numbers::pi * std::round((last - heading) / (2 * std::numbers::pi));
    errors.push_back({pose.t_s, std::atan2(std::hypot(up.x(), up.y()), up.z()), heading});
  }
  return errors;
}

Metrics score_orientation(const OrientationScoreInput& input) {
  Metrics metrics;
  const std::vector<OrientationError> errors = orientation_errors(input.estimate, input.truth);
  if (errors.empty()) return metrics;
  double squares = 0;
  for (const OrientationError& e : errors) squares += e.tilt_rad * e.tilt_rad;
  metrics.set("orientation.roll_pitch_rmse_deg",
              std::sqrt(squares / static_cast<double>(errors.size())) / kDegree);
  const GyroBiasEstimate* rest = end_of_rest(input.biases);
  std::span<const OrientationError> later = errors;
  if (rest != nullptr) {
    const double rest_s = seconds_from_ns(rest->t_ns);
    const auto from = std::find_if(errors.begin(), errors.end(),
                                   [&](const OrientationError& e) { return e.t_s >= rest_s; });
    later = later.subspan(static_cast<std::size_t>(from - errors.begin()));
    score_bias(*rest, input.imu_truth, metrics);
  }
  const auto slope = heading_slope(later);
  metrics.set("orientation.yaw_drift_deg_per_min",
              slope ? std::optional(std::abs(*slope) * 60 / kDegree) : std::nullopt);
  return metrics;
}

Metrics score_rates(std::span<const StampedTwist> estimate, std::span<const StampedTwist> truth) {
  Metrics metrics;
  double squares = 0, peak = 0, count = 0;
  for (const StampedTwist& one : estimate) {
    const std::size_t after = count_until(truth, one.t_s, &StampedTwist::t_s);
    if (after == 0 || after == truth.size()) continue;
    const StampedTwist &a = truth[after - 1], &b = truth[after];
    const double weight = (one.t_s - a.t_s) / (b.t_s - a.t_s);
    const Eigen::Vector3d rate =
        a.angular_velocity + weight * (b.angular_velocity - a.angular_velocity);
    squares += (one.angular_velocity - rate).squaredNorm();
    peak = std::max(peak, rate.norm());
    ++count;
  }
  if (!(count > 0)) return metrics;
  const double rmse = std::sqrt(squares / count);
  metrics.set("orientation.rate_rmse_rad_s", rmse);
  metrics.set("orientation.rate_peak_rad_s", peak);
  metrics.set("orientation.rate_rmse_percent",
              peak > 0 ? std::optional(100 * rmse / peak) : std::nullopt);
  return metrics;
}

}  // namespace saccade
