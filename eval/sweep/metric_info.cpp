#include "eval/sweep/metric_info.h"

#include <array>
#include <string_view>
#include <vector>

namespace saccade {
namespace {

using Better = MetricInfo::Better;

bool contains_any(std::string_view text, std::span<const std::string_view> parts) {
  for (const std::string_view part : parts)
    if (text.find(part) != std::string_view::npos) return true;
  return false;
}

Better guessed_direction(std::string_view key) {
  static constexpr std::array<std::string_view, 12> kHigher{
      "per_s",   "realtime_factor", "coverage",  "delta_1", "completeness", "ssim",
      "pearson", "observed",        "precision", "recall",  "sharpness",    "span"};
  static constexpr std::array<std::string_view, 13> kNeither{
      "dataset.",       "poses",          "points",       "pairs",        "scale",
      "duration_s",     "path_length",    "mean_depth_m", "speed.events", "repetitions",
      "within_1_sigma", "within_2_sigma", "nees"};
  if (key.starts_with("trajectory.rpe.per_second")) return Better::kLower;
  if (contains_any(key, kHigher)) return Better::kHigher;
  return contains_any(key, kNeither) ? Better::kNeither : Better::kLower;
}

}  // namespace

std::span<const MetricInfo> usual_metrics() {
  static const std::vector<MetricInfo> metrics{
      {"trajectory.dt_rel_percent.mean", "dt_rel [%]", Better::kLower, false, true},
      {"trajectory.dtheta_deg.mean", "dtheta [deg]", Better::kLower, false, true},
      {"trajectory.lost_s", "lost [s]", Better::kLower, false, false},
      {"depth.rel_mean", "mean depth error", Better::kLower, false, true},
      {"depth.rel_median", "median depth error", Better::kLower, false, true},
      {"depth.completeness", "completeness", Better::kHigher, false, true},
      {"reconstruction.ssim", "SSIM", Better::kHigher, false, true},
      {"reconstruction.mse", "MSE", Better::kLower, false, true},
      {"speed.poses_per_s", "poses/s", Better::kHigher, true, true},
      {"speed.events_per_s", "events/s", Better::kHigher, true, false},
      {"speed.realtime_factor", "x real time", Better::kHigher, true, false},
      {"speed.events", "processed events", Better::kNeither, false, false},
      {"dataset.events", "events", Better::kNeither, false, true},
      {"dataset.duration_s", "duration [s]", Better::kNeither, false, false},
      {"dataset.mean_scene_depth_m", "mean depth [m]", Better::kNeither, false, false},
      {"dataset.path_length_m", "path [m]", Better::kNeither, false, false},
      {"dataset.rays_per_event", "rays per event", Better::kNeither, false, false},
      {"dataset.time_bound_us", "time bound [us]", Better::kNeither, false, false},
  };
  return metrics;
}

MetricInfo metric_info(const std::string& key) {
  for (const MetricInfo& metric : usual_metrics())
    if (metric.key == key) return metric;
  return {key, key, guessed_direction(key), key.starts_with("speed."), false};
}

}  // namespace saccade
