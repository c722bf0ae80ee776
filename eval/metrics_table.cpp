#include <fmt/format.h>

#include "eval/evaluate.h"
#include "eval/number_text.h"

namespace saccade {
namespace {

void add_errors(std::string& text, const Metrics& metrics) {
  text += fmt::format("  {:<14}{:>10}{:>10}{:>10}{:>10}\n", "", "mean", "sigma", "max", "RMSE");
  const auto row = [&](const char* label, const std::string& key, int decimals) {
    text += fmt::format("  {:<14}", label);
    for (const char* name : {".mean", ".sigma", ".max", ".rmse"})
      text += fmt::format("{:>10}", fixed(metrics.get("trajectory." + key + name), decimals));
    text += "\n";
  };
  row("dt_rel [%]", "dt_rel_percent", 3);
  row("dtheta [deg]", "dtheta_deg", 3);
  row("dt [m]", "dt_m", 4);
}

void add_alignments(std::string& text, const Metrics& metrics) {
  text +=
      fmt::format("  {:<14}{:>10}{:>10}{:>10}\n", "alignment", "ATE [mm]", "rot [deg]", "scale");
  for (const char* name : {"none", "se3", "sim3"}) {
    const std::string key = std::string("trajectory.") + name;
    std::optional<double> ate_mm = metrics.get(key + ".ate_rmse_m");
    if (ate_mm) *ate_mm *= 1000;
    text += fmt::format("  {:<14}{:>10}{:>10}{:>10}\n", name, fixed(ate_mm, 2),
                        fixed(metrics.get(key + ".rot_rmse_deg"), 3),
                        fixed(metrics.get(key + ".scale"), 5));
  }
}

void add_tracking(std::string& text, const Metrics& metrics) {
  const auto get = [&](const char* key) { return metrics.get(std::string("trajectory.") + key); };
  std::optional<double> coverage = get("coverage");
  if (coverage) *coverage *= 100;
  text += fmt::format("  {} poses over {} s, coverage {} %, lost {} s (reported {} s)\n",
                      grouped(get("poses")), fixed(get("duration_s"), 3), fixed(coverage, 2),
                      fixed(get("lost_s"), 3), fixed(get("reported_lost_s"), 3));
  text += fmt::format("  path {} m, end drift {} %, per second {} m and {} deg\n",
                      fixed(get("path_length_m"), 3), fixed(get("drift_percent"), 3),
                      fixed(get("rpe.per_second.trans_rmse_m"), 4),
                      fixed(get("rpe.per_second.rot_rmse_deg"), 3));
  if (metrics.values().contains("trajectory.reprojection_px.rms"))
    text +=
        fmt::format("  reprojection {} px RMS, worst instant {} px RMS, worst point {} px\n",
                    fixed(get("reprojection_px.rms"), 3), fixed(get("reprojection_px.rms_max"), 3),
                    fixed(get("reprojection_px.max"), 2));
}

void add_depth(std::string& text, const Metrics& metrics) {
  const auto get = [&](const std::string& key) { return metrics.get("depth." + key); };
  const auto percent = [&](const std::string& key, int decimals = 2) {
    std::optional<double> value = get(key);
    if (value) *value *= 100;
    return fixed(value, decimals);
  };
  text += fmt::format("  {:<14}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}\n", "depth", "median %",
                      "mean %", "> 5 %", "RMSE [m]", "1 sigma %", "2 sigma %");
  for (const std::string prefix : {"", "strict."})
    text += fmt::format("  {:<14}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}\n",
                        prefix.empty() ? "best of 3 x 3" : "strict", percent(prefix + "rel_median"),
                        percent(prefix + "rel_mean"), percent(prefix + "outlier_5_percent"),
                        fixed(get(prefix + "rmse_m"), 4), percent(prefix + "within_1_sigma", 1),
                        percent(prefix + "within_2_sigma", 1));
  text += fmt::format("  {} points in {} views, completeness {} %\n", grouped(get("points")),
                      grouped(get("views.count")), percent("completeness", 1));
  const auto spread = [&](const char* name) {
    const std::string key = std::string("views.") + name;
    return fmt::format("{} (worst {})", percent(key + ".median"), percent(key + ".worst"));
  };
  text += fmt::format("  per view: median {} %, mean {} %, over 5 % {} %, completeness {} %\n",
                      spread("rel_median"), spread("rel_mean"), spread("outlier_5_percent"),
                      spread("completeness"));
  text += fmt::format("  per view: {} points (fewest {})\n", grouped(get("views.points.median")),
                      grouped(get("views.points.worst")));
  if (get("two_planes.angle_deg"))
    text += fmt::format("  two planes at {} deg hold {} % of the points\n",
                        fixed(get("two_planes.angle_deg"), 2), percent("two_planes.share", 1));
}

void add_reconstruction(std::string& text, const Metrics& metrics) {
  const auto get = [&](const std::string& key) { return metrics.get("reconstruction." + key); };
  std::optional<double> observed = get("observed");
  if (observed) *observed *= 100;
  text += fmt::format("  {:<14}{:>10}{:>10}{:>10}{:>14}{:>12}{:>10}\n", "image", "SSIM", "Pearson",
                      "RMSE log", "grad Pearson", "observed %", "views");
  text += fmt::format("  {:<14}{:>10}{:>10}{:>10}{:>14}{:>12}{:>10}\n", "mean",
                      fixed(get("ssim"), 4), fixed(get("pearson"), 4), fixed(get("rmse_log"), 4),
                      fixed(get("gradient_pearson"), 4), fixed(observed, 1), grouped(get("views")));
  text += fmt::format("  {:<14}{:>10}{:>10}\n", "worst view", fixed(get("worst.ssim"), 4),
                      fixed(get("worst.pearson"), 4));
}

void add_orientation(std::string& text, const Metrics& metrics) {
  const auto get = [&](const char* key) { return metrics.get(std::string("orientation.") + key); };
  text += fmt::format("  roll and pitch {} deg RMSE, heading drifts by {} deg/min\n",
                      fixed(get("roll_pitch_rmse_deg"), 3), fixed(get("yaw_drift_deg_per_min"), 2));
  if (get("bias_error_rad_s"))
    text += fmt::format("  gyroscope's bias after the first rest: {} rad/s off, believed {}\n",
                        fixed(get("bias_error_rad_s"), 6), fixed(get("bias_sigma_rad_s"), 6));
}

void add_rates(std::string& text, const Metrics& metrics) {
  const auto get = [&](const char* key, int decimals) {
    return fixed(metrics.get(std::string("orientation.rate_") + key), decimals);
  };
  text += fmt::format("  angular velocity {} rad/s RMSE, {} % of the peak of {} rad/s\n",
                      get("rmse_rad_s", 4), get("rmse_percent", 2), get("peak_rad_s", 2));
}

void add_sharpness(std::string& text, const Metrics& metrics) {
  const auto get = [&](const char* key) { return fixed(metrics.get(key), 1); };
  text += fmt::format("  sharpness: raw {}, stabilized {}, by the true rotation {}\n",
                      get("sharpness.raw"), get("sharpness.stabilized"), get("sharpness.truth"));
  std::optional<double> within = metrics.get("stabilization.within_1px");
  if (!within) return;
  *within *= 100;
  text += fmt::format("  {} % of the events within 1 px of their true place\n", fixed(within, 2));
}

void add_mosaic(std::string& text, const Metrics& metrics) {
  const auto get = [&](const char* key) { return metrics.get(std::string("mosaic.") + key); };
  std::optional<double> observed = get("observed");
  if (observed) *observed *= 100;
  text += fmt::format("  {:<14}{:>10}{:>10}{:>10}{:>14}\n", "mosaic", "SSIM", "Pearson", "RMSE log",
                      "grad Pearson");
  text += fmt::format("  {:<14}{:>10}{:>10}{:>10}{:>14}\n", "by the start", fixed(get("ssim"), 4),
                      fixed(get("pearson"), 4), fixed(get("rmse_log"), 4),
                      fixed(get("gradient_pearson"), 4));
  text +=
      fmt::format("  {:<14}{:>10}{:>10}   turned by {} deg, orientations then off by {} deg\n",
                  "by the mean", fixed(get("aligned.ssim"), 4), fixed(get("aligned.pearson"), 4),
                  fixed(get("alignment.rotation_deg"), 3), fixed(get("alignment.residual_deg"), 3));
  text += fmt::format("  {} % of the swept area observed; {} fields of view by area, {} by width\n",
                      fixed(observed, 1), fixed(get("span.solid_angle"), 2),
                      fixed(get("span.horizontal"), 2));
}

void add_ratios(std::string& text, const Metrics& metrics) {
  const auto get = [&](const char* key) {
    return fixed(metrics.get(std::string("refined_ratio.") + key), 2);
  };
  if (metrics.values().contains("refined_ratio.trajectory.dt_rel_percent.mean"))
    text += fmt::format("  x refined optimum: dt_rel {}, dtheta {} (means)\n",
                        get("trajectory.dt_rel_percent.mean"), get("trajectory.dtheta_deg.mean"));
  if (metrics.values().contains("refined_ratio.depth.rel_median"))
    text += fmt::format("  x refined optimum: depth {} (median), {} (mean)\n",
                        get("depth.rel_median"), get("depth.rel_mean"));
}

void add_speed(std::string& text, const Metrics& metrics) {
  const auto get = [&](const char* key) {
    return speed_value(metrics, std::string("speed.") + key);
  };
  std::optional<double> wall_ms = get("wall_s");
  if (wall_ms) *wall_ms *= 1000;
  const bool has_poses = metrics.values().contains("trajectory.poses");
  text += fmt::format("  {} ms, {} events/s, {}{} x real time\n", fixed(wall_ms, 1),
                      grouped(get("events_per_s")),
                      has_poses ? grouped(get("poses_per_s")) + " poses/s, " : "",
                      fixed(get("realtime_factor"), 2));
}

}  // namespace

std::optional<double> speed_value(const Metrics& metrics, const std::string& key) {
  if (const std::optional<double> value = metrics.get(key)) return value;
  return metrics.get(key + ".median");
}

std::string format_metrics(const Metrics& metrics, const std::string& title) {
  std::string text = title + "\n";
  if (metrics.values().contains("trajectory.poses")) {
    add_errors(text, metrics);
    add_alignments(text, metrics);
    add_tracking(text, metrics);
  }
  if (metrics.values().contains("depth.points")) add_depth(text, metrics);
  if (metrics.values().contains("reconstruction.views")) add_reconstruction(text, metrics);
  if (metrics.get("orientation.roll_pitch_rmse_deg")) add_orientation(text, metrics);
  if (metrics.values().contains("mosaic.ssim")) add_mosaic(text, metrics);
  if (metrics.get("orientation.rate_rmse_rad_s")) add_rates(text, metrics);
  if (metrics.get("sharpness.stabilized")) add_sharpness(text, metrics);
  add_ratios(text, metrics);
  if (metrics.get("trajectory.nees"))
    text += fmt::format("  NEES {} of 6\n", fixed(metrics.get("trajectory.nees"), 2));
  if (speed_value(metrics, "speed.wall_s")) add_speed(text, metrics);
  return text;
}

}  // namespace saccade
