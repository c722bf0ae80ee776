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

/// An estimated angular velocity and the true one [rad/s].
struct RatePair {
  Eigen::Vector3d estimate, truth;
};
using RatePairs = std::vector<RatePair>;

Metrics score_pairs(const RatePairs& pairs) {
  Metrics metrics;
  if (pairs.empty()) return metrics;
  double squares = 0, peak = 0;
  for (const RatePair& pair : pairs) {
    squares += (pair.estimate - pair.truth).squaredNorm();
    peak = std::max(peak, pair.truth.norm());
  }
  const double rmse = std::sqrt(squares / static_cast<double>(pairs.size()));
  metrics.set("orientation.rate_rmse_rad_s", rmse);
  metrics.set("orientation.rate_peak_rad_s", peak);
  metrics.set("orientation.rate_rmse_percent",
              peak > 0 ? std::optional(100 * rmse / peak) : std::nullopt);
  return metrics;
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
  RatePairs pairs;
  for (const StampedTwist& one : estimate) {
    const std::size_t after = count_until(truth, one.t_s, &StampedTwist::t_s);
    if (after == 0 || after == truth.size()) continue;
    const StampedTwist &a = truth[after - 1], &b = truth[after];
    const double weight = (one.t_s - a.t_s) / (b.t_s - a.t_s);
    const Eigen::Vector3d rate =
        a.angular_velocity + weight * (b.angular_velocity - a.angular_velocity);
    pairs.push_back({one.angular_velocity, rate});
  }
  return score_pairs(pairs);
}

Metrics score_rates_by_gyroscope(std::span<const StampedTwist> estimate,
                                 std::span<const ImuSample> gyroscope,
                                 const Rigid3& camera_from_imu) {
  if (estimate.size() < 2 || gyroscope.empty()) return {};
  const auto readings_before = [&](double t_s) {
    return count_before(gyroscope, ns_from_seconds(t_s), &ImuSample::t_ns);
  };
  const Eigen::Matrix3d rotation = camera_from_imu.rotation_matrix();
  RatePairs pairs;
  Eigen::Vector3d mean_difference = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    const double t_s = estimate[i].t_s;
    const double before_s = i > 0 ? (t_s - estimate[i - 1].t_s) / 2 : 0;
    const double after_s = i + 1 < estimate.size() ? (estimate[i + 1].t_s - t_s) / 2 : before_s;
    const std::size_t begin = readings_before(t_s - (i > 0 ? before_s : after_s));
    const std::size_t end = readings_before(t_s + after_s);
    if (begin >= end) continue;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const ImuSample& one : gyroscope.subspan(begin, end - begin)) sum += one.angular_velocity;
    const Eigen::Vector3d rate = rotation * sum / static_cast<double>(end - begin);
    pairs.push_back({estimate[i].angular_velocity, rate});
    mean_difference += estimate[i].angular_velocity - rate;
  }
  for (RatePair& pair : pairs) pair.truth += mean_difference / static_cast<double>(pairs.size());
  return score_pairs(pairs);
}

}  // namespace saccade
