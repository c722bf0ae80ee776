#include "eval/report/tables.h"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "eval/evaluate.h"
#include "eval/number_text.h"
#include "eval/report/html.h"
#include "eval/report/thesis.h"

namespace saccade {
namespace {

/// Ours above the thesis's, which is left out where there is none.
std::string cell(const std::string& ours, const std::string& theirs, bool starts_group = false) {
  if (theirs == fixed(std::nullopt, 0))
    return fmt::format("<td{}>{}</td>", starts_group ? " class=\"space\"" : "", ours);
  return fmt::format("<td{}>{}<span class=\"ref\">{}</span></td>",
                     starts_group ? " class=\"space\"" : "", ours, theirs);
}

std::string printed(const std::optional<double>& thesis) {
  return thesis ? fmt::format("{:.{}f}", *thesis, *thesis < 10 ? 1 : 0) : "–";
}

/// "3.4×", green above 1 and red below.
std::string factor_cell(const std::optional<double>& factor) {
  if (!factor) return "<td class=\"space\">–</td>";
  return fmt::format("<td class=\"space\"><span class=\"{}\">{}×</span></td>",
                     *factor >= 1 ? "better" : "worse", significant(factor, 2));
}

std::optional<double> ratio(const std::optional<double>& a, const std::optional<double>& b) {
  if (!a || !b || *b == 0) return std::nullopt;
  return *a / *b;
}

std::string name_cell(const RunData& data) {
  return fmt::format("<td class=\"name\"><a href=\"#{}\">{}</a><span class=\"ref\">{}</span></td>",
                     data.id, escape_html(data.run.name()),
                     escape_html(data.run.record.module + " on " + data.dataset));
}

std::string error_cells(const Metrics& metrics, const std::string& key, int decimals,
                        const thesis::Errors* thesis) {
  std::string cells;
  const auto add = [&](const char* name, double thesis::Errors::*member) {
    std::optional<double> theirs;
    if (thesis != nullptr) theirs = thesis->*member;
    cells += cell(fixed(metrics.get(key + "." + name), decimals), printed(theirs),
                  std::string_view(name) == "mean");
  };
  add("mean", &thesis::Errors::mean);
  add("sigma", &thesis::Errors::sigma);
  add("max", &thesis::Errors::max);
  add("rmse", &thesis::Errors::rmse);
  std::optional<double> theirs;
  if (thesis != nullptr) theirs = thesis->mean;
  return cells + factor_cell(ratio(theirs, metrics.get(key + ".mean")));
}

/// How many times the refined optimum's errors are, where a run is compared with one.
std::string refined_cell(const RunData& data, std::initializer_list<const char*> keys) {
  std::string text;
  for (const char* key : keys)
    text += (text.empty() ? "" : " / ") +
            significant(data.metrics.get(std::string("refined_ratio.") + key), 2);
  return fmt::format("<td class=\"space\">{}</td>", text);
}

constexpr const char* kRefinedHead = "<th class=\"space\">&times; refined optimum</th>";

std::string accuracy_row(const RunData& data, bool with_refined) {
  const thesis::Tracking* thesis = thesis::find_tracking(data.dataset, data.fast);
  const auto errors = [&](const char* key, thesis::Errors thesis::Tracking::*member) {
    return error_cells(data.metrics, std::string("trajectory.") + key, 2,
                       thesis == nullptr ? nullptr : &(thesis->*member));
  };
  std::optional<double> coverage = data.metrics.get("trajectory.coverage");
  if (coverage) *coverage *= 100;
  return "<tr>" + name_cell(data) + errors("dt_rel_percent", &thesis::Tracking::dt_rel_percent) +
         errors("dtheta_deg", &thesis::Tracking::dtheta_deg) +
         fmt::format("<td class=\"space\">{} %</td>", fixed(coverage, 1)) +
         (with_refined
              ? refined_cell(data, {"trajectory.dt_rel_percent.mean", "trajectory.dtheta_deg.mean"})
              : "") +
         "</tr>\n";
}

std::string depth_row(const RunData& data, bool with_refined) {
  const auto percent = [&](const std::string& key, int decimals) {
    std::optional<double> value = data.metrics.get("depth." + key);
    if (value) *value *= 100;
    return fixed(value, decimals);
  };
  const auto with_worst = [&](const std::string& key, int decimals, bool starts_group) {
    return cell(percent(key, decimals), percent("views." + key + ".worst", decimals), starts_group);
  };
  const auto alone = [&](const std::string& key, int decimals, bool starts_group) {
    return cell(percent(key, decimals), fixed(std::nullopt, 0), starts_group);
  };
  return "<tr>" + name_cell(data) + with_worst("rel_median", 2, true) +
         with_worst("rel_mean", 2, false) + with_worst("outlier_5_percent", 2, false) +
         alone("strict.rel_median", 2, true) + alone("strict.rel_mean", 2, false) +
         with_worst("completeness", 1, true) +
         cell(grouped(data.metrics.get("depth.views.points.median")),
              grouped(data.metrics.get("depth.views.points.worst"))) +
         alone("within_1_sigma", 1, true) + alone("within_2_sigma", 1, false) +
         (with_refined ? refined_cell(data, {"depth.rel_median", "depth.rel_mean"}) : "") +
         "</tr>\n";
}

std::string deviation_cell(const std::optional<double>& ours, const std::optional<double>& theirs,
                           const std::string& shown) {
  std::string reference = printed(theirs);
  if (const std::optional<double> share = ratio(ours, theirs))
    reference += fmt::format(" ({:+.0f} %)", std::round(100 * (*share - 1)) + 0.0);
  return cell(shown, reference);
}

std::string dataset_row(const RunData& data) {
  const thesis::Sequence* thesis = thesis::find_sequence(data.dataset);
  const auto theirs = [&](double thesis::Sequence::*member) -> std::optional<double> {
    if (thesis == nullptr) return std::nullopt;
    return thesis->*member;
  };
  const DatasetNumbers& n = data.numbers;
  std::optional<double> millions = n.events;
  if (millions) *millions /= 1e6;
  const std::optional<double> thesis_ratio =
      ratio(theirs(&thesis::Sequence::path_m), theirs(&thesis::Sequence::mean_depth_m));
  const auto row_cell = [&](const std::optional<double>& ours, double thesis::Sequence::*member) {
    return deviation_cell(ours, theirs(member), significant(ours));
  };
  return fmt::format("<tr><td>{}</td>", escape_html(data.dataset)) +
         row_cell(millions, &thesis::Sequence::events_millions) +
         row_cell(n.duration_s, &thesis::Sequence::duration_s) +
         row_cell(n.mean_depth_m, &thesis::Sequence::mean_depth_m) +
         row_cell(n.path_m, &thesis::Sequence::path_m) +
         cell(fixed(ratio(n.path_m, n.mean_depth_m), 2), fixed(thesis_ratio, 2)) + "</tr>\n";
}

/// Table 8.3 is about tracking; other modules have nothing to be compared with.
const thesis::Tracking* thesis_speed(const RunData& data) {
  if (data.run.record.module != "track") return nullptr;
  return thesis::find_tracking(data.dataset, data.fast);
}

std::string speed_row(const RunData& data) {
  const thesis::Tracking* thesis = thesis_speed(data);
  const auto value = [&](const char* key, double scale) {
    std::optional<double> v = speed_value(data.metrics, std::string("speed.") + key);
    if (v) *v *= scale;
    return v;
  };
  const auto theirs = [&](double thesis::Tracking::*member) -> std::optional<double> {
    if (thesis == nullptr) return std::nullopt;
    return thesis->*member;
  };
  const std::optional<double> rate = value("events_per_s", 1e-6);
  std::optional<double> poses = value("poses_per_s", 1);
  if (data.metrics.get("depth.points") && !data.metrics.get("trajectory.poses")) poses.reset();
  return "<tr>" + name_cell(data) +
         cell(significant(value("wall_s", 1e3)), printed(theirs(&thesis::Tracking::time_ms)),
              true) +
         cell(significant(rate), printed(theirs(&thesis::Tracking::events_per_s_millions)), true) +
         factor_cell(ratio(rate, theirs(&thesis::Tracking::events_per_s_millions))) +
         cell(grouped(poses), grouped(theirs(&thesis::Tracking::poses_per_s)), true) +
         factor_cell(ratio(poses, theirs(&thesis::Tracking::poses_per_s))) +
         fmt::format("<td class=\"space\">{}</td><td class=\"space\">{}</td></tr>\n",
                     significant(value("realtime_factor", 1)),
                     data.run.record.threads > 0 ? std::to_string(data.run.record.threads) : "–");
}

bool has_any(std::span<const RunData> runs, std::string_view prefix) {
  for (const RunData& data : runs)
    for (const auto& [key, value] : data.metrics.values())
      if (key.starts_with(prefix) && value) return true;
  return false;
}

}  // namespace

std::string accuracy_table(std::span<const RunData> runs) {
  if (!has_any(runs, "trajectory.")) return "";
  std::string html =
      "<section id=\"accuracy\"><h2>Tracking accuracy</h2>\n"
      "<p>Without alignment, over a uniform 1 ms grid. &Delta;t<sub>rel</sub> is the position "
      "error "
      "relative to the mean scene depth. The smaller number below is the thesis's (table 8.2); the "
      "factor compares the means.</p>\n<div class=\"scroll\"><table class=\"wide\"><thead>\n"
      "<tr><th></th><th class=\"group space\" colspan=\"5\">&Delta;t<sub>rel</sub> [%]</th>"
      "<th class=\"group space\" colspan=\"5\">&Delta;&theta; [deg]</th><th></th></tr>\n"
      "<tr><th>run</th>";
  for (int i = 0; i < 2; ++i)
    html +=
        "<th class=\"space\">mean</th><th>&sigma;</th><th>max</th><th>RMSE</th>"
        "<th class=\"space\">better by</th>";
  const bool with_refined = has_any(runs, "refined_ratio.trajectory.");
  html += "<th class=\"space\">coverage</th>";
  if (with_refined) html += kRefinedHead;
  html += "</tr></thead><tbody>\n";
  for (const RunData& data : runs)
    if (data.metrics.get("trajectory.poses")) html += accuracy_row(data, with_refined);
  return html + "</tbody></table></div></section>\n";
}

std::string depth_table(std::span<const RunData> runs) {
  if (!has_any(runs, "depth.")) return "";
  std::string html =
      "<section id=\"depth\"><h2>Depth</h2>\n<p>Relative errors |d - d<sub>truth</sub>| / "
      "d<sub>truth</sub> against the best pixel of the 3 x 3 around a point, over all views; "
      "strict: "
      "at its exact position. The smaller number below is that of the worst view.</p>\n"
      "<div class=\"scroll\"><table class=\"wide\"><thead><tr><th>run</th>"
      "<th class=\"space\">median [%]</th><th>mean [%]</th><th>over 5 % [%]</th>"
      "<th class=\"space\">strict median [%]</th><th>strict mean [%]</th>"
      "<th class=\"space\">complete [%]</th><th>points per view</th>"
      "<th class=\"space\">within 1 &sigma; [%]</th><th>2 &sigma; [%]</th>";
  const bool with_refined = has_any(runs, "refined_ratio.depth.");
  if (with_refined) html += kRefinedHead;
  html += "</tr></thead><tbody>\n";
  for (const RunData& data : runs)
    if (data.metrics.get("depth.points")) html += depth_row(data, with_refined);
  return html + "</tbody></table></div></section>\n";
}

std::string dataset_table(std::span<const RunData> runs) {
  std::string html =
      "<section id=\"datasets\"><h2>Datasets</h2>\n<p>Below each number the thesis's (table 8.1) "
      "and "
      "the deviation from it.</p>\n<div class=\"scroll\"><table class=\"wide\"><thead><tr>"
      "<th>dataset</th><th>events [M]</th><th>duration [s]</th><th>mean depth [m]</th>"
      "<th>path length [m]</th>"
      "<th>path / depth</th></tr></thead><tbody>\n";
  std::set<std::string> shown;
  for (const RunData& data : runs)
    if (shown.insert(data.dataset).second) html += dataset_row(data);
  return html + "</tbody></table></div></section>\n";
}

std::string speed_table(std::span<const RunData> runs) {
  if (!has_any(runs, "speed.")) return "";
  std::string html =
      "<section id=\"speed\"><h2>Speed</h2>\n<p>Without reading and writing files; medians where a "
      "run was repeated. The smaller number below is the thesis's (table 8.3).</p>\n"
      "<div class=\"scroll\"><table class=\"wide\"><thead><tr><th>run</th>"
      "<th class=\"space\">time [ms]</th><th class=\"space\">events/s [M]</th>"
      "<th class=\"space\">faster by</th><th class=\"space\">poses/s</th>"
      "<th class=\"space\">faster by</th><th class=\"space\">&times; real time</th>"
      "<th class=\"space\">threads</th></tr></thead><tbody>\n";
  for (const RunData& data : runs)
    if (speed_value(data.metrics, "speed.wall_s")) html += speed_row(data);
  return html + "</tbody></table></div>\n<p class=\"note\">" + escape_html(thesis::kSpeedErratum) +
         "</p></section>\n";
}

}  // namespace saccade
