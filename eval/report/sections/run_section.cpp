#include "eval/report/sections/page_sections.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "core/io/events/event_file.h"
#include "core/process/shell.h"
#include "eval/evaluate.h"
#include "eval/metrics/catalogue.h"
#include "eval/picture/view/sensor_view.h"
#include "eval/report/charts/page_data.h"
#include "eval/report/html.h"
#include "eval/report/sections/module_sections.h"
#include "eval/table/number_text.h"
#include "eval/table/table.h"

namespace saccade {
namespace {

/// The numbers at the head of a run with their labels (HTML), in this order; one that was not
/// measured is left out.
constexpr std::pair<const char*, const char*> kKeyNumbers[] = {
    {"trajectory.dt_rel_percent.mean", "mean &Delta;t<sub>rel</sub>"},
    {"trajectory.dt_m.mean", "mean &Delta;t"},
    {"trajectory.dtheta_deg.mean", "mean &Delta;&theta;"},
    {"trajectory.reprojection_px.rms", "map in the image, RMS"},
    {"depth.rel_median", "median error of depth"},
    {"depth.rel_mean", "mean error of depth"},
    {"depth.completeness", "of the edge pixels found"},
    {"depth.points", "points"},
    {"mosaic.ssim", "SSIM of the mosaic"},
    {"mosaic.span.solid_angle", "fields of view"},
    {"orientation.roll_pitch_rmse_deg", "roll and pitch, RMSE"},
    {"orientation.yaw_drift_deg_per_min", "drift of the heading"},
    {"orientation.rate_rmse_rad_s", "angular velocity, RMSE"},
    {"orientation.rate_rmse_percent", "of its peak"},
    {"sharpness.raw", "sharpness of the events as fired"},
    {"sharpness.stabilized", "stabilized"},
    {"sharpness.fwl", "times as sharp as fired"},
    {"sharpness.truth", "by the true rotation"},
    {"trajectory.coverage", "of the time covered"},
    {"trajectory.poses", "poses"},
};

std::string key_number(const std::string& shown, const std::string& unit, const char* label) {
  return fmt::format("<li><b>{}<small>{}</small></b><span>{}</span></li>", shown, unit, label);
}

std::string key_numbers(const RunData& data) {
  const Metrics& m = data.metrics;
  std::string html;
  for (const auto& [key, label] : kKeyNumbers) {
    const std::optional<double> value = shown_value(m, key);
    const bool is_relative_too =
        std::string_view(key) == "trajectory.dt_m.mean" && m.get("trajectory.dt_rel_percent.mean");
    if (!value || is_relative_too) continue;
    const bool is_count = std::string_view(label) == "points" || std::string_view(label) == "poses";
    html += key_number(is_count ? grouped(value) : significant(value),
                       metric_info(key).shown_unit(), label);
  }
  const bool has_poses =
      m.get("trajectory.poses") || !(m.get("depth.points") || m.get("sharpness.raw") ||
                                     m.get("mosaic.ssim") || m.get("orientation.rate_rmse_rad_s"));
  const char* unit = has_poses ? "poses" : "events";
  if (const auto rate = speed_value(m, fmt::format("speed.{}_per_s", unit)))
    html += key_number(grouped(rate), "/s", unit);
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
      "aria-label=\"Exaggerate the error\"></label>"
      "<label hidden><input type=\"checkbox\">map</label>"
      "<figcaption>Drag to rotate, click and scroll to zoom."
      "<i class=\"swatch\" style=\"background:var(--truth)\"></i>truth"
      "<i class=\"swatch\" style=\"background:var(--estimate)\"></i>estimate. The slider "
      "multiplies the error; dots mark the starts.</figcaption></figure>\n"
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
  for (const double fraction : kMoments) {
    const double t_s = start_s + fraction * length_s;
    const SensorView view(*data.data, t_s, t_s, {});
    const auto& map = data.keyframes ? data.keyframes->map_at(t_s) : data.map;
    html += figure(view.map_over_events(t_s, map, held_pose(data.input.estimate, t_s)),
                   fmt::format("{:.3f} s", t_s) + swatch(kDarkTheme.map, "map") +
                       swatch(kDarkTheme.on, "ON") + swatch(kDarkTheme.off, "OFF"),
                   fmt::format("map over events at {:.3f} s", t_s));
  }
  return html + "</div>\n";
}

std::string alignment_table(const RunData& data) {
  Table table{data.id + "_alignments", "All poses, after alignment", {{"alignment"}}};
  table.add_numeric({"ATE RMSE [mm]", "rotation RMSE [deg]", "scale"});
  for (const auto& [key, name] :
       {std::pair{"none", "none"}, {"yaw", "yaw"}, {"se3", "SE(3)"}, {"sim3", "Sim(3)"}}) {
    const std::string prefix = std::string("trajectory.") + key;
    const auto ate_mm = shown_value(data.metrics, prefix + ".ate_rmse_m");
    const auto rotation_deg = data.metrics.get(prefix + ".rot_rmse_deg");
    const auto scale = data.metrics.get(prefix + ".scale");
    table.rows.push_back({{name},
                          number_cell(ate_mm, significant(ate_mm)),
                          number_cell(rotation_deg, significant(rotation_deg)),
                          number_cell(scale, fixed(scale, 4))});
  }
  return table_html(table);
}

std::string relative_table(const RunData& data) {
  Table table{
      data.id + "_relative", "Relative errors over parts of the path", {{"part of the path"}}};
  table.add_numeric({"translation [%]", "rotation [deg/m]"});
  for (int percent = 10; percent <= 50; percent += 10) {
    const std::string key = fmt::format("trajectory.rpe.length_{}_percent", percent);
    const auto translation = data.metrics.get(key + ".trans_percent");
    const auto rotation = data.metrics.get(key + ".rot_deg_per_m");
    table.rows.push_back({{fmt::format("{} %", percent)},
                          number_cell(translation, significant(translation)),
                          number_cell(rotation, significant(rotation))});
  }
  return table_html(table);
}

std::string accuracy_details(const RunData& data) {
  if (!data.metrics.get("trajectory.poses")) return "";
  const Metrics& m = data.metrics;
  return "<div class=\"grid\"><div>" + alignment_table(data) +
         fmt::format(
             "<p class=\"note\">{}Drift at the end {} % of the path. Lost for {} s by the truth, "
             "{} s by its own report, {} s of the loss unreported. Worst instant of the map in the "
             "image: {} px RMS.</p>",
             m.get("trajectory.aligned_freedoms")
                 ? fmt::format("No pose was given at the start: errors are those {}. ",
                               alignment_text(alignment_of(*m.get("trajectory.aligned_freedoms"))))
                 : "",
             significant(m.get("trajectory.drift_percent")),
             significant(m.get("trajectory.lost_s")),
             significant(m.get("trajectory.reported_lost_s")),
             significant(m.get("trajectory.loss.unreported_s")),
             significant(m.get("trajectory.reprojection_px.rms_max"))) +
         "</div><div>" + relative_table(data) + "</div></div>\n";
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
    const double percent = 100 * parts[i].second / total;
    bar += fmt::format("<i class=\"c{}\" style=\"width:{:.2f}%\"></i>", i % 6, percent);
    legend += fmt::format("<li><i class=\"c{}\"></i>{} {} ms ({:.0f} %)</li>", i % 6,
                          escape_html(parts[i].first), significant(1e3 * parts[i].second), percent);
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
  if (r.smooth_poses_s) add("poses smoothed by", fmt::format("{:g} s", *r.smooth_poses_s));
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
  const RunRecord::Window span = time_span(*data.data);
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

std::string run_section(const RunData& data, const RunSectionParts& parts) {
  std::string html;
  if (!data.data)
    html += fmt::format("<p class=\"note\">{}: only the stored numbers are shown.</p>",
                        escape_html(data.missing));
  html += key_numbers(data) + views(data) + (parts.film ? film_section(data) : "");
  if (data.data && parts.pictures) {
    html += map_pictures(data) + keyframe_section(data) + depth_section(data) + image_section(data);
    html += mosaic_section(data) + stabilization_section(data) + rotation_section(data);
    html += reconstruction_stage_section(data);
  }
  if (!parts.pictures)
    html +=
        "<p class=\"note\">A page of many runs has the pictures of a method's first run on each "
        "dataset.</p>\n";
  return html + accuracy_details(data) + stages(data) + provenance(data) +
         repeat_html(commands(data));
}

}  // namespace saccade
