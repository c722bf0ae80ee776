#include "eval/metrics/trajectory/relative_error.h"

#include <cmath>
#include <utility>

#include "eval/metrics/statistics.h"

namespace saccade {
namespace {

/// Below this a path is noise, and an error relative to it means nothing.
constexpr double kMinPathM = 1e-6;

/// truth_ij^-1 estimated_ij.
Rigid3 relative_error(const ScoredSamples& s, std::size_t i, std::size_t j) {
  const Rigid3 true_motion = s.truth[i].inverse() * s.truth[j];
  return true_motion.inverse() * (s.estimated[i].inverse() * s.estimated[j]);
}

struct PairErrors {
  std::vector<double> trans_m, trans_percent, rot_deg, rot_deg_per_m;

  void add(const Rigid3& error, double path_m) {
    const double angle = kDegreesPerRadian * so3_log(error.rotation()).norm();
    trans_m.push_back(error.translation().norm());
    rot_deg.push_back(angle);
    if (path_m <= 0) return;
    trans_percent.push_back(100 * error.translation().norm() / path_m);
    rot_deg_per_m.push_back(angle / path_m);
  }
};

std::optional<double> mean(std::span<const double> values) {
  return values.empty() ? std::nullopt : std::optional(statistics_of(values).mean);
}

std::optional<double> rmse(std::span<const double> values) {
  return values.empty() ? std::nullopt : std::optional(statistics_of(values).rmse);
}

PairErrors errors_over_length(const ScoredSamples& samples, std::span<const double> path,
                              double length_m) {
  PairErrors errors;
  // The last sub-trajectory of 50 % must not fall out because of a sum's last bit.
  const double reached_m = length_m * (1 - 1e-9);
  for (std::size_t i = 0, j = 0; i < path.size(); ++i) {
    while (j < path.size() && path[j] - path[i] < reached_m) ++j;
    if (j == path.size()) break;
    errors.add(relative_error(samples, i, j), path[j] - path[i]);
  }
  return errors;
}

void set_length_errors(Metrics& metrics, const std::string& key, const PairErrors& errors) {
  metrics.set(key + ".pairs", static_cast<double>(errors.trans_m.size()));
  metrics.set(key + ".trans_rmse_m", rmse(errors.trans_m));
  metrics.set(key + ".trans_percent", mean(errors.trans_percent));
  metrics.set(key + ".rot_rmse_deg", rmse(errors.rot_deg));
  metrics.set(key + ".rot_deg_per_m", mean(errors.rot_deg_per_m));
}

}  // namespace

SegmentErrors segment_errors(const ScoredSamples& samples, double percent) {
  const std::vector<double> path = path_lengths(samples);
  if (path.empty() || path.back() < kMinPathM) return {};
  PairErrors errors = errors_over_length(samples, path, path.back() * percent / 100);
  return {std::move(errors.trans_percent), std::move(errors.rot_deg_per_m)};
}

std::vector<double> path_lengths(const ScoredSamples& samples) {
  std::vector<double> lengths;
  for (std::size_t i = 0; i < samples.truth.size(); ++i) {
    const double increment_m =
        i == 0 ? 0 : (samples.truth[i].translation() - samples.truth[i - 1].translation()).norm();
    lengths.push_back(i == 0 ? 0 : lengths.back() + increment_m);
  }
  return lengths;
}

void set_relative_errors(Metrics& metrics, const ScoredSamples& samples) {
  const std::vector<double> path = path_lengths(samples);
  const bool moves = !path.empty() && path.back() >= kMinPathM;
  for (int percent = 10; percent <= 50; percent += 10) {
    const std::string key = "trajectory.rpe.length_" + std::to_string(percent) + "_percent";
    set_length_errors(
        metrics, key,
        moves ? errors_over_length(samples, path, path.back() * percent / 100) : PairErrors{});
  }
  PairErrors errors;
  const auto second = static_cast<std::size_t>(std::lround(1 / kScoreStepS));
  for (std::size_t i = 0; i + second < path.size(); ++i)
    errors.add(relative_error(samples, i, i + second), 0);
  metrics.set("trajectory.rpe.per_second.pairs", static_cast<double>(errors.trans_m.size()));
  metrics.set("trajectory.rpe.per_second.trans_rmse_m", rmse(errors.trans_m));
  metrics.set("trajectory.rpe.per_second.rot_rmse_deg", rmse(errors.rot_deg));
}

std::optional<double> drift_percent(const ScoredSamples& samples) {
  const std::vector<double> path = path_lengths(samples);
  if (path.empty() || path.back() < kMinPathM) return std::nullopt;
  return 100 * relative_error(samples, 0, path.size() - 1).translation().norm() / path.back();
}

}  // namespace saccade
