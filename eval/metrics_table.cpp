#include <fmt/format.h>

#include <sstream>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "core/io/events/labels_h5.h"
#include "eval/evaluate.h"
#include "eval/metrics/catalogue.h"
#include "eval/metrics/trajectory/align.h"
#include "eval/table/number_text.h"
#include "eval/table/table.h"

namespace saccade {
namespace {

/// Values of one part of the metrics as text, in the units that people are shown.
class Shown {
 public:
  Shown(const Metrics& metrics, std::string prefix)
      : metrics_(metrics), prefix_(std::move(prefix)) {}

  [[nodiscard]] std::string fixed(const std::string& key, int decimals) const {
    return saccade::fixed(shown_value(metrics_, prefix_ + key), decimals);
  }
  [[nodiscard]] std::string grouped(const std::string& key) const {
    return saccade::grouped(metrics_.get(prefix_ + key));
  }
  [[nodiscard]] bool has(const std::string& key) const {
    return metrics_.get(prefix_ + key).has_value();
  }

 private:
  const Metrics& metrics_;
  std::string prefix_;
};

Table table_of(std::vector<std::string> titles) {
  Table table{.columns = {{titles.front()}}};
  for (std::size_t i = 1; i < titles.size(); ++i) table.columns.push_back({titles[i], true});
  return table;
}

/// Below the title of the scores.
void add(std::string& text, const Table& table) {
  std::istringstream lines(table_text(table));
  for (std::string line; std::getline(lines, line);) text += "  " + line + "\n";
}

void add_errors(std::string& text, const Metrics& metrics) {
  if (const std::optional<double> freedoms = metrics.get("trajectory.aligned_freedoms"))
    text += fmt::format("  errors {}\n", alignment_text(alignment_of(*freedoms)));
  Table table = table_of({"", "mean", "sigma", "max", "RMSE"});
  for (const auto& [label, key, decimals] : {std::tuple{"dt_rel [%]", "dt_rel_percent", 3},
                                             {"dtheta [deg]", "dtheta_deg", 3},
                                             {"dt [mm]", "dt_m", 1}}) {
    const Shown of(metrics, std::string("trajectory.") + key);
    table.add({label, of.fixed(".mean", decimals), of.fixed(".sigma", decimals),
               of.fixed(".max", decimals), of.fixed(".rmse", decimals)});
  }
  add(text, table);
}

void add_alignments(std::string& text, const Metrics& metrics) {
  Table table = table_of({"alignment", "ATE [mm]", "rot [deg]", "scale"});
  for (const char* name : {"none", "yaw", "se3", "sim3"}) {
    const Shown of(metrics, std::string("trajectory.") + name);
    table.add(
        {name, of.fixed(".ate_rmse_m", 2), of.fixed(".rot_rmse_deg", 3), of.fixed(".scale", 5)});
  }
  add(text, table);
}

void add_tracking(std::string& text, const Metrics& metrics) {
  const Shown of(metrics, "trajectory.");
  text += fmt::format("  {} poses over {} s, coverage {} %\n", of.grouped("poses"),
                      of.fixed("duration_s", 3), of.fixed("coverage", 2));
  text += fmt::format("  lost {} s, reported {} s, unreported {} s\n", of.fixed("lost_s", 3),
                      of.fixed("reported_lost_s", 3), of.fixed("loss.unreported_s", 3));
  if (of.has("loss.recall"))
    text += fmt::format("  losses {}, recall {} %, precision {} %, delay {} ms\n",
                        of.grouped("loss.count"), of.fixed("loss.recall", 1),
                        of.fixed("loss.precision", 1), of.fixed("loss.delay_ms", 1));
  text += fmt::format("  path {} m, end drift {} %, per second {} m and {} deg\n",
                      of.fixed("path_length_m", 3), of.fixed("drift_percent", 3),
                      of.fixed("rpe.per_second.trans_rmse_m", 4),
                      of.fixed("rpe.per_second.rot_rmse_deg", 3));
  if (metrics.values().contains("trajectory.reprojection_px.rms"))
    text += fmt::format("  reprojection {} px RMS, worst instant {} px RMS, worst point {} px\n",
                        of.fixed("reprojection_px.rms", 3), of.fixed("reprojection_px.rms_max", 3),
                        of.fixed("reprojection_px.max", 2));
}

void add_depth(std::string& text, const Metrics& metrics) {
  Table table =
      table_of({"depth", "median %", "mean %", "> 5 %", "RMSE [m]", "1 sigma %", "2 sigma %"});
  for (const auto& [name, prefix] :
       {std::pair{"best of 3 x 3", "depth."}, {"strict", "depth.strict."}}) {
    const Shown of(metrics, prefix);
    table.add({name, of.fixed("rel_median", 2), of.fixed("rel_mean", 2),
               of.fixed("outlier_5_percent", 2), of.fixed("rmse_m", 4),
               of.fixed("within_1_sigma", 1), of.fixed("within_2_sigma", 1)});
  }
  add(text, table);
  const Shown of(metrics, "depth.");
  text += fmt::format("  {} points in {} views, completeness {} %\n", of.grouped("points"),
                      of.grouped("views.count"), of.fixed("completeness", 1));
  const auto spread = [&](const std::string& name) {
    return fmt::format("{} (worst {})", of.fixed("views." + name + ".median", 2),
                       of.fixed("views." + name + ".worst", 2));
  };
  text += fmt::format("  per view: median {} %, mean {} %, over 5 % {} %, completeness {} %\n",
                      spread("rel_median"), spread("rel_mean"), spread("outlier_5_percent"),
                      spread("completeness"));
  text += fmt::format("  per view: {} points (fewest {})\n", of.grouped("views.points.median"),
                      of.grouped("views.points.worst"));
  if (of.has("two_planes.angle_deg"))
    text += fmt::format("  two planes at {} deg hold {} % of the points\n",
                        of.fixed("two_planes.angle_deg", 2), of.fixed("two_planes.share", 1));
}

void add_reconstruction(std::string& text, const Metrics& metrics) {
  const Shown of(metrics, "reconstruction.");
  Table table =
      table_of({"image", "SSIM", "Pearson", "RMSE log", "grad Pearson", "observed %", "views"});
  table.add({"mean", of.fixed("ssim", 4), of.fixed("pearson", 4), of.fixed("rmse_log", 4),
             of.fixed("gradient_pearson", 4), of.fixed("observed", 1), of.grouped("views")});
  table.add(
      {"worst view", of.fixed("worst.ssim", 4), of.fixed("worst.pearson", 4), "", "", "", ""});
  add(text, table);
}

void add_orientation(std::string& text, const Metrics& metrics) {
  const Shown of(metrics, "orientation.");
  text += fmt::format("  roll and pitch {} deg RMSE, heading drifts by {} deg/min\n",
                      of.fixed("roll_pitch_rmse_deg", 3), of.fixed("yaw_drift_deg_per_min", 2));
  if (of.has("bias_error_rad_s"))
    text +=
        fmt::format("  error of the gyroscope's bias after the first rest: {} rad/s, sigma {}\n",
                    of.fixed("bias_error_rad_s", 6), of.fixed("bias_sigma_rad_s", 6));
}

void add_rates(std::string& text, const Metrics& metrics) {
  const Shown of(metrics, "orientation.rate_");
  text += fmt::format("  angular velocity {} rad/s RMSE, {} % of the peak of {} rad/s\n",
                      of.fixed("rmse_rad_s", 4), of.fixed("rmse_percent", 2),
                      of.fixed("peak_rad_s", 2));
}

void add_sharpness(std::string& text, const Metrics& metrics) {
  const Shown of(metrics, "");
  text += fmt::format("  sharpness: raw {}, stabilized {} ({} times), by the true rotation {}\n",
                      of.fixed("sharpness.raw", 1), of.fixed("sharpness.stabilized", 1),
                      of.fixed("sharpness.fwl", 2), of.fixed("sharpness.truth", 1));
  if (of.has("stabilization.within_1px"))
    text += fmt::format("  {} % of the events within 1 px of their true position\n",
                        of.fixed("stabilization.within_1px", 2));
}

void add_mosaic(std::string& text, const Metrics& metrics) {
  const Shown of(metrics, "mosaic.");
  Table table = table_of({"mosaic", "SSIM", "Pearson", "RMSE log", "grad Pearson"});
  table.add({"aligned at the start", of.fixed("ssim", 4), of.fixed("pearson", 4),
             of.fixed("rmse_log", 4), of.fixed("gradient_pearson", 4)});
  table.add(
      {"aligned by all", of.fixed("aligned.ssim", 4), of.fixed("aligned.pearson", 4), "", ""});
  add(text, table);
  text += fmt::format("  the alignments differ by {} deg; error of the orientations {} deg RMS\n",
                      of.fixed("alignment.rotation_deg", 3), of.fixed("alignment.residual_deg", 3));
  text += fmt::format("  {} % of the swept area observed; {} fields of view by area, {} by width\n",
                      of.fixed("observed", 1), of.fixed("span.solid_angle", 2),
                      of.fixed("span.horizontal", 2));
}

void add_events(std::string& text, const Metrics& metrics) {
  const Shown of(metrics, "events.");
  text += fmt::format("  {} events, {} in the truth: {} x\n", of.grouped("count"),
                      of.grouped("true_count"), of.fixed("ratio", 4));
  Table table = table_of({"partners within", "precision %", "recall %"});
  for (const char* tolerance : {"1us", "10us", "100us"})
    table.add({tolerance, of.fixed(std::string("precision_") + tolerance, 3),
               of.fixed(std::string("recall_") + tolerance, 3)});
  for (const char* polarity : {"on", "off"}) {
    const Shown part(metrics, std::string("events.") + polarity + ".");
    table.add({fmt::format("10us, {} ({} x)", polarity, part.fixed("ratio", 4)),
               part.fixed("precision_10us", 3), part.fixed("recall_10us", 3)});
  }
  for (const std::string_view origin : kEventOriginNames) {
    const Shown part(metrics, fmt::format("events.origin.{}.", origin));
    if (part.has("precision_10us") || part.has("recall_10us"))
      table.add({fmt::format("10us, {}", origin), part.fixed("precision_10us", 3),
                 part.fixed("recall_10us", 3)});
  }
  add(text, table);
  text += fmt::format("  time error of pairs: median {} us (signed {}), 99 % below {} us\n",
                      of.fixed("median_dt_us", 3), of.fixed("median_signed_dt_us", 3),
                      of.fixed("p99_dt_us", 3));
}

void add_ratios(std::string& text, const Metrics& metrics) {
  const Shown of(metrics, "refined_ratio.");
  if (metrics.values().contains("refined_ratio.trajectory.dt_rel_percent.mean"))
    text += fmt::format("  x refined optimum: dt_rel {}, dtheta {} (means)\n",
                        of.fixed("trajectory.dt_rel_percent.mean", 2),
                        of.fixed("trajectory.dtheta_deg.mean", 2));
  if (metrics.values().contains("refined_ratio.depth.rel_median"))
    text += fmt::format("  x refined optimum: depth {} (median), {} (mean)\n",
                        of.fixed("depth.rel_median", 2), of.fixed("depth.rel_mean", 2));
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
  if (metrics.values().contains("events.count")) add_events(text, metrics);
  add_ratios(text, metrics);
  if (metrics.get("trajectory.nees"))
    text += fmt::format("  NEES {} of 6\n", fixed(metrics.get("trajectory.nees"), 2));
  if (speed_value(metrics, "speed.wall_s")) add_speed(text, metrics);
  return text;
}

}  // namespace saccade
