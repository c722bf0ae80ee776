#include "eval/report/run_section.h"

#include <fmt/format.h>

#include "core/io/event_file.h"
#include "core/shell.h"
#include "eval/evaluate.h"
#include "eval/number_text.h"
#include "eval/picture/view/sensor_view.h"
#include "eval/report/depth_section.h"
#include "eval/report/film_section.h"
#include "eval/report/html.h"
#include "eval/report/image_section.h"
#include "eval/report/keyframe_section.h"
#include "eval/report/mosaic_section.h"
#include "eval/report/page_data.h"
#include "eval/report/rotation_section.h"
#include "eval/report/stabilization_section.h"
#include "eval/report/step_section.h"

namespace saccade {
namespace {

std::string key_numbers(const RunData& data) {
  const Metrics& m = data.metrics;
  std::string html;
  const auto add = [&](const std::optional<double>& value, const std::string& shown,
                       const char* unit, const char* label) {
    if (value)
      html += fmt::format("<li><b>{}<small>{}</small></b><span>{}</span></li>", shown, unit, label);
  };
  const auto score = [&](const char* key, double scale, const char* unit, const char* label) {
    std::optional<double> value = m.get(std::string("trajectory.") + key);
    if (value) *value *= scale;
    add(value, significant(value), unit, label);
  };
  score("dt_rel_percent.mean", 1, "%", "mean &Delta;t<sub>rel</sub>");
  if (!m.get("trajectory.dt_rel_percent.mean")) score("dt_m.mean", 1e3, "mm", "mean &Delta;t");
  score("dtheta_deg.mean", 1, "deg", "mean &Delta;&theta;");
  score("reprojection_px.rms", 1, "px", "map in the image, RMS");
  const auto depth = [&](const char* key, const char* label) {
    std::optional<double> value = m.get(std::string("depth.") + key);
    if (value) *value *= 100;
    add(value, significant(value), "%", label);
  };
  depth("rel_median", "median error of depth");
  depth("rel_mean", "mean error of depth");
  depth("completeness", "of the edge pixels found");
  add(m.get("depth.points"), grouped(m.get("depth.points")), "", "points");
  const auto plain = [&](const char* key, const char* unit, const char* label) {
    add(m.get(key), significant(m.get(key)), unit, label);
  };
  plain("mosaic.ssim", "", "SSIM of the mosaic");
  plain("mosaic.span.solid_angle", "", "fields of view");
  plain("orientation.roll_pitch_rmse_deg", "deg", "roll and pitch, RMSE");
  plain("orientation.yaw_drift_deg_per_min", "deg/min", "drift of the heading");
  plain("orientation.rate_rmse_rad_s", "rad/s", "angular velocity, RMSE");
  plain("orientation.rate_rmse_percent", "%", "of its peak");
  plain("sharpness.raw", "", "sharpness of the events as fired");
  plain("sharpness.stabilized", "", "stabilized");
  plain("sharpness.truth", "", "by the true rotation");
  std::optional<double> coverage = m.get("trajectory.coverage");
  if (coverage) *coverage *= 100;
  add(coverage, fixed(coverage, 1), "%", "of the time covered");
  const std::optional<double> poses = m.get("trajectory.poses");
  add(poses, grouped(poses), "", "poses");
  const bool has_poses =
      poses.has_value() || !(m.get("depth.points") || m.get("sharpness.raw") ||
                             m.get("mosaic.ssim") || m.get("orientation.rate_rmse_rad_s"));
  const char* unit = has_poses ? "poses" : "events";
  const std::optional<double> rate = speed_value(m, fmt::format("speed.{}_per_s", unit));
  add(rate, grouped(rate), "/s", unit);
  return html.empty() ? "" : "<ul class=\"keys\">" + html + "</ul>\n";
}

std::string views(const RunData& data) {
  if (data.samples.t_s.empty()) return "";
  const auto plot = [&](const char* name, const char* title) {
    return fmt::format("<div><h4>{}</h4><div data-plot=\"{}/{}\"></div></div>\n", title, data.id,
                       name);
  };
  std::string html = fmt::format(
      "<div class=\"grid\"><figure class=\"space3d\" data-space=\"{}\">"
      "<canvas role=\"img\" tabindex=\"0\" aria-label=\"Trajectory in 3-D\"></canvas>"
      "<label><output></output><input type=\"range\" min=\"0\" max=\"6\" value=\"0\" "
      "aria-label=\"Exaggerate the deviation\"></label>"
      "<label hidden><input type=\"checkbox\">map</label>"
      "<figcaption>Drag to turn, click and scroll to zoom."
      "<i class=\"swatch\" style=\"background:var(--truth)\"></i>truth"
      "<i class=\"swatch\" style=\"background:var(--estimate)\"></i>estimate. The slider "
      "multiplies the deviation from the truth; dots mark the starts.</figcaption></figure>\n"
      "<div class=\"plots\">",
      data.id);
  if (!data.errors.dt_rel_percent.empty())
    html += plot("dt_rel", "&Delta;t<sub>rel</sub> [% of the mean scene depth]");
  else
    html += plot("dt", "&Delta;t [mm]");
  html += plot("dtheta", "&Delta;&theta; [deg]");
  if (!data.reprojection.t_s.empty())
    html += plot("reprojection", "map reprojected by the estimate, RMS [px]");
  return html +
         "<p class=\"note\">Dashed: the mean. Shaded: no pose within 20 ms; the last one is "
         "held.</p>"
         "</div></div>\n<script type=\"application/json\" data-run=\"" +
         data.id + "\">" + run_page_data(data) + "</script>\n";
}

std::string swatch(const Rgb8& colour, const char* name) {
  return fmt::format("<i class=\"swatch\" style=\"background:rgb({},{},{})\"></i>{}", colour[0],
                     colour[1], colour[2], name);
}

std::string map_pictures(const RunData& data) {
  if (data.map.empty() || data.input.estimate.empty() || data.samples.t_s.empty()) return "";
  constexpr double kMoments[] = {0.1, 0.5, 0.9};
  const double start_s = data.samples.t_s.front();
  const double length_s = data.samples.t_s.back() - start_s;
  std::string html =
      "<h4>Map projected with the estimated pose, over the events</h4>"
      "<div class=\"grid three\">";
  for (const double share : kMoments) {
    const double t_s = start_s + share * length_s;
    const SensorView view(*data.data, t_s, t_s, {});
    const auto& map = data.keyframes ? data.keyframes->map_at(t_s) : data.map;
    html += figure(view.map_over_events(t_s, map, held_pose(data.input.estimate, t_s)),
                   fmt::format("{:.3f} s", t_s) + swatch(kDarkTheme.map, "map") +
                       swatch(kDarkTheme.on, "ON") + swatch(kDarkTheme.off, "OFF"),
                   fmt::format("map over events at {:.3f} s", t_s));
  }
  return html + "</div>\n";
}

std::string alignment_table(const Metrics& metrics) {
  std::string html =
      "<div class=\"scroll\"><table><thead><tr><th>alignment</th><th>ATE RMSE [mm]</th>"
      "<th>rotation RMSE [deg]</th><th>scale</th></tr></thead><tbody>\n";
  for (const auto& [key, name] :
       {std::pair{"none", "none"}, {"se3", "SE(3)"}, {"sim3", "Sim(3)"}}) {
    const std::string prefix = std::string("trajectory.") + key;
    std::optional<double> ate_mm = metrics.get(prefix + ".ate_rmse_m");
    if (ate_mm) *ate_mm *= 1000;
    html += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n", name,
                        significant(ate_mm), significant(metrics.get(prefix + ".rot_rmse_deg")),
                        fixed(metrics.get(prefix + ".scale"), 4));
  }
  return html + "</tbody></table></div>";
}

std::string relative_table(const Metrics& metrics) {
  std::string html =
      "<div class=\"scroll\"><table><thead><tr><th>share of the path</th><th>translation [%]</th>"
      "<th>rotation [deg/m]</th></tr></thead><tbody>\n";
  for (int percent = 10; percent <= 50; percent += 10) {
    const std::string key = fmt::format("trajectory.rpe.length_{}_percent", percent);
    html += fmt::format("<tr><td>{} %</td><td>{}</td><td>{}</td></tr>\n", percent,
                        significant(metrics.get(key + ".trans_percent")),
                        significant(metrics.get(key + ".rot_deg_per_m")));
  }
  return html + "</tbody></table></div>";
}

std::string accuracy_details(const RunData& data) {
  if (!data.metrics.get("trajectory.poses")) return "";
  const Metrics& m = data.metrics;
  return "<div class=\"grid\"><div><h4>All poses, after alignment</h4>" + alignment_table(m) +
         fmt::format(
             "<p class=\"note\">Drift at the end {} % of the path. Lost for {} s by the truth, "
             "{} s by its own report. Worst instant of the map in the image: {} px RMS.</p>",
             significant(m.get("trajectory.drift_percent")),
             significant(m.get("trajectory.lost_s")),
             significant(m.get("trajectory.reported_lost_s")),
             significant(m.get("trajectory.reprojection_px.rms_max"))) +
         "</div><div><h4>Relative errors over parts of the path</h4>" + relative_table(m) +
         "</div></div>\n";
}

std::string stages(const RunData& data) {
  const std::string prefix = "speed.stages_s.";
  std::vector<std::pair<std::string, double>> parts;
  double total = 0;
  for (const auto& [key, value] : data.metrics.values())
    if (key.starts_with(prefix) && value) {
      parts.emplace_back(key.substr(prefix.size()), *value);
      total += *value;
    }
  if (!(total > 0)) return "";
  std::string bar, legend;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const double share = 100 * parts[i].second / total;
    bar += fmt::format("<i class=\"c{}\" style=\"width:{:.2f}%\"></i>", i % 6, share);
    legend += fmt::format("<li><i class=\"c{}\"></i>{} {} ms ({:.0f} %)</li>", i % 6,
                          escape_html(parts[i].first), significant(1e3 * parts[i].second), share);
  }
  const auto ms = [&](const char* key) {
    std::optional<double> v = speed_value(data.metrics, std::string("speed.") + key);
    if (v) *v *= 1e3;
    return significant(v);
  };
  return fmt::format(
      "<h4>Time per stage</h4><div class=\"stages\">{}</div><ul class=\"legend\">{}</ul>"
      "<p class=\"note\">{} ms in all (fastest {}, slowest {}; {} repetitions), reading and "
      "writing "
      "{} ms more, peak memory {} MB.</p>\n",
      bar, legend, ms("wall_s"), ms("wall_s.min"), ms("wall_s.max"),
      grouped(data.metrics.get("speed.repetitions")), ms("io_s"),
      significant(data.metrics.get("speed.peak_memory_mb")));
}

std::string provenance(const RunData& data) {
  const RunRecord& r = data.run.record;
  std::string list;
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) list += fmt::format("<dt>{}</dt><dd>{}</dd>", name, escape_html(value));
  };
  add("command", r.command);
  add("module", r.module);
  add("dataset", r.dataset.string());
  add("poses from", r.poses_from.string());
  add("depth from", r.depth_from.string());
  add("dataset hash", r.dataset_sha256);
  if (r.window)
    add("window", fmt::format("{:.6f} .. {:.6f} s", r.window->start_s, r.window->end_s));
  add("seed", std::to_string(r.seed));
  add("threads", r.threads > 0 ? std::to_string(r.threads) : "");
  add("version", r.tool_version);
  add("machine", r.machine);
  std::string html =
      "<details><summary>Provenance and configuration</summary><dl>" + list + "</dl>";
  if (!r.config_yaml.empty()) html += "<pre>" + escape_html(r.config_yaml) + "</pre>";
  return html + "</details>\n";
}

/// The run, its scores, its picture and its film.
std::vector<std::string> commands(const RunData& data) {
  const std::string folder = data.run.folder.string();
  std::vector<std::string> lines{data.run.record.command};
  lines.push_back(shell_line(std::vector<std::string>{"saccade", "eval", folder}));
  if (data.data)
    for (const char* ending : {".png", ".mp4"})
      lines.push_back(shell_line(
          std::vector<std::string>{"saccade", "render", folder, "-o", data.run.name() + ending}));
  return lines;
}

}  // namespace

std::string dataset_pictures(const RunData& data) {
  if (!data.data || data.data->events_file().empty()) return "";
  const TimeSpan span = time_span(*data.data);
  const double t_s = (span.start_s + span.end_s) / 2;
  const SensorView view(*data.data, t_s, t_s, {});
  // Only the events need hard pixels; pictures are interpolated by the browser.
  const SensorView plain(*data.data, t_s, t_s, {.upscale = 1});
  std::string html = "<div class=\"grid three\">";
  html += figure(view.events(t_s),
                 fmt::format("Events around {:.3f} s", t_s) + swatch(kDarkTheme.on, "ON") +
                     swatch(kDarkTheme.off, "OFF"),
                 "events");
  if (const auto frame = plain.frame(t_s)) html += figure(*frame, "Grey frame", "grey frame");
  if (const auto depth = view.plain_depth(t_s))
    html += figure(depth->image,
                   fmt::format("Depth, {} m (bright) to {} m (dark)",
                               significant(depth->range.near_m), significant(depth->range.far_m)),
                   "depth map");
  return html + "</div>\n";
}

std::string run_section(const RunData& data, bool film) {
  std::string html = fmt::format("<section id=\"{}\" class=\"run\"><h3>{}</h3>\n", data.id,
                                 escape_html(data.run.name()));
  if (!data.data)
    html += fmt::format("<p class=\"note\">{}: only the stored numbers are shown.</p>",
                        escape_html(data.missing));
  html += key_numbers(data) + views(data) + (film ? film_section(data) : "");
  if (data.data) {
    html += map_pictures(data) + keyframe_section(data) + depth_section(data) + image_section(data);
    html += mosaic_section(data) + stabilization_section(data) + rotation_section(data);
  }
  return html + step_section(data) + accuracy_details(data) + stages(data) + provenance(data) +
         repeat_html(commands(data)) + "</section>\n";
}

}  // namespace saccade
