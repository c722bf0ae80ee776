#include "eval/report/sections/page_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <set>

#include "eval/evaluate.h"
#include "eval/metrics/catalogue.h"
#include "eval/report/html.h"
#include "eval/report/reference/thesis.h"
#include "eval/table/number_text.h"
#include "eval/table/table.h"

namespace saccade {
namespace {

using Cell = Table::Cell;
using Row = std::vector<Cell>;
using Number = std::optional<double>;

/// The thesis's number as it is printed there; nothing where it has none.
std::string printed(const Number& thesis) {
  return thesis ? fmt::format("{:.{}f}", *thesis, *thesis < 10 ? 1 : 0) : "";
}

Number ratio(const Number& a, const Number& b) {
  if (!a || !b || *b == 0) return std::nullopt;
  return *a / *b;
}

Number scaled(Number value, double scale) {
  if (value) *value *= scale;
  return value;
}

/// "3.4×", in the colour of better above 1 and of worse below.
Cell factor_cell(const Number& factor) {
  if (!factor) return {"–"};
  Cell cell = number_cell(factor, significant(factor, 2) + "×");
  cell.mark = *factor >= 1 ? Table::Mark::kBetter : Table::Mark::kWorse;
  return cell;
}

Cell run_cell(const RunData& data) {
  Cell cell{data.run.name(), {}, data.run.record.module + " on " + data.dataset};
  cell.link = data.address;
  return cell;
}

/// How many times the refined optimum's errors are.
Cell refined_cell(const RunData& data, std::initializer_list<const char*> keys) {
  std::string text;
  for (const char* key : keys)
    text += (text.empty() ? "" : " / ") +
            significant(data.metrics.get(std::string("refined_ratio.") + key), 2);
  return {text};
}

constexpr const char* kRefined = "× refined optimum";

void add_errors(Row& row, const RunData& data, const std::string& key) {
  const auto ours = [&](const char* name) { return data.metrics.get(key + name); };
  const auto theirs = [&](const char* name) {
    return thesis_value(key + name, data.dataset, data.run.record);
  };
  for (const char* name : {".mean", ".sigma", ".max", ".rmse"})
    row.push_back(number_cell(ours(name), fixed(ours(name), 2), printed(theirs(name))));
  row.push_back(factor_cell(ratio(theirs(".mean"), ours(".mean"))));
}

bool has_any(std::span<const RunData> runs, std::string_view prefix) {
  return std::any_of(runs.begin(), runs.end(), [&](const RunData& data) {
    const auto& values = data.metrics.values();
    return std::any_of(values.begin(), values.end(), [&](const auto& metric) {
      return metric.first.starts_with(prefix) && metric.second;
    });
  });
}

std::string section(const char* id, const char* heading, const std::string& text,
                    const Table& table, const std::string& note = "") {
  return fmt::format("<section id=\"{}\"><h2>{}</h2>\n<p>{}</p>\n{}{}</section>\n", id, heading,
                     text, table_html(table),
                     note.empty() ? "" : "<p class=\"note\">" + escape_html(note) + "</p>");
}

Row depth_row(const RunData& data, bool with_refined) {
  Row row{run_cell(data)};
  // Fractions stand in percent.
  const auto add = [&](const std::string& key, int decimals, bool with_worst) {
    const Number value = shown_value(data.metrics, "depth." + key);
    const Number worst = shown_value(data.metrics, "depth.views." + key + ".worst");
    row.push_back(number_cell(value, fixed(value, decimals),
                              with_worst && worst ? fixed(worst, decimals) : ""));
  };
  for (const char* key : {"rel_median", "rel_mean", "outlier_5_percent"}) add(key, 2, true);
  for (const char* key : {"strict.rel_median", "strict.rel_mean"}) add(key, 2, false);
  add("completeness", 1, true);
  const Number points = data.metrics.get("depth.views.points.median");
  const Number fewest = data.metrics.get("depth.views.points.worst");
  row.push_back(number_cell(points, grouped(points), fewest ? grouped(fewest) : ""));
  for (const char* key : {"within_1_sigma", "within_2_sigma"}) add(key, 1, false);
  if (with_refined) row.push_back(refined_cell(data, {"depth.rel_median", "depth.rel_mean"}));
  return row;
}

Row dataset_row(const RunData& data) {
  Row row{{data.dataset}};
  const auto theirs = [&](const char* key) {
    return thesis_value(key, data.dataset, data.run.record);
  };
  const auto add = [&](const char* key, double scale) {
    const Number ours = scaled(data.facts.get(key), scale), thesis = scaled(theirs(key), scale);
    std::string note = printed(thesis);
    if (const Number quotient = ratio(ours, thesis))
      note += fmt::format(" ({:+.0f} %)", std::round(100 * (*quotient - 1)) + 0.0);
    row.push_back(number_cell(ours, significant(ours), note));
  };
  constexpr const char* kDepth = "dataset.mean_scene_depth_m";
  constexpr const char* kPath = "dataset.path_length_m";
  add("dataset.events", 1e-6);
  for (const char* key : {"dataset.duration_s", kDepth, kPath}) add(key, 1);
  const Number ours = ratio(data.facts.get(kPath), data.facts.get(kDepth));
  const Number thesis = ratio(theirs(kPath), theirs(kDepth));
  row.push_back(number_cell(ours, fixed(ours, 2), thesis ? fixed(thesis, 2) : ""));
  return row;
}

Row speed_row(const RunData& data) {
  const auto ours = [&](const char* key, double scale) {
    return scaled(speed_value(data.metrics, std::string("speed.") + key), scale);
  };
  // Table 8.3 is about tracking; other modules have nothing to be compared with.
  const auto theirs = [&](const char* key, double scale) -> Number {
    if (data.run.record.module != "track") return std::nullopt;
    return scaled(thesis_value(std::string("speed.") + key, data.dataset, data.run.record), scale);
  };
  Row row{run_cell(data)};
  const Number wall_ms = ours("wall_s", 1e3), rate = ours("events_per_s", 1e-6);
  row.push_back(number_cell(wall_ms, significant(wall_ms), printed(theirs("wall_s", 1e3))));
  row.push_back(number_cell(rate, significant(rate), printed(theirs("events_per_s", 1e-6))));
  row.push_back(factor_cell(ratio(rate, theirs("events_per_s", 1e-6))));
  Number poses = ours("poses_per_s", 1);
  if (data.metrics.get("depth.points") && !data.metrics.get("trajectory.poses")) poses.reset();
  const Number thesis_poses = theirs("poses_per_s", 1);
  row.push_back(number_cell(poses, grouped(poses), thesis_poses ? grouped(thesis_poses) : ""));
  row.push_back(factor_cell(ratio(poses, thesis_poses)));
  const Number realtime = ours("realtime_factor", 1);
  row.push_back(number_cell(realtime, significant(realtime)));
  const int threads = data.run.record.threads;
  row.push_back(threads > 0 ? number_cell(threads, std::to_string(threads)) : Cell{"–"});
  return row;
}

}  // namespace

std::string accuracy_table(std::span<const RunData> runs) {
  if (!has_any(runs, "trajectory.")) return "";
  Table table{"accuracy", "Errors of the poses, without alignment", {{"run"}}};
  const bool with_refined = has_any(runs, "refined_ratio.trajectory.");
  table.add_numeric({"dt_rel [%]: mean", "σ", "max", "RMSE", "better by", "dtheta [deg]: mean", "σ",
                     "max", "RMSE", "better by", "coverage [%]"});
  if (with_refined) table.add_numeric({kRefined});
  for (const RunData& data : runs) {
    if (!data.metrics.get("trajectory.poses")) continue;
    Row& row = table.rows.emplace_back();
    row.push_back(run_cell(data));
    add_errors(row, data, "trajectory.dt_rel_percent");
    add_errors(row, data, "trajectory.dtheta_deg");
    const Number coverage = shown_value(data.metrics, "trajectory.coverage");
    row.push_back(number_cell(coverage, fixed(coverage, 1)));
    if (with_refined)
      row.push_back(
          refined_cell(data, {"trajectory.dt_rel_percent.mean", "trajectory.dtheta_deg.mean"}));
  }
  return section(
      "accuracy", "Tracking accuracy",
      "Over a uniform 1 ms grid. dt_rel is the position error relative to the mean scene "
      "depth, dtheta the rotation error. The smaller number below is the thesis's (table "
      "8.2); the factor compares the means.",
      table);
}

std::string depth_table(std::span<const RunData> runs) {
  if (!has_any(runs, "depth.")) return "";
  Table table{"depth", "Relative errors of depth, over all views", {{"run"}}};
  const bool with_refined = has_any(runs, "refined_ratio.depth.");
  table.add_numeric({"median [%]", "mean [%]", "over 5 % [%]", "strict median [%]",
                     "strict mean [%]", "complete [%]", "points per view", "within 1 σ [%]",
                     "within 2 σ [%]"});
  if (with_refined) table.add_numeric({kRefined});
  for (const RunData& data : runs)
    if (data.metrics.get("depth.points")) table.rows.push_back(depth_row(data, with_refined));
  return section("depth", "Depth",
                 "Relative errors |d - d<sub>truth</sub>| / d<sub>truth</sub> against the best "
                 "pixel of the 3 x 3 around a point; strict: at its exact position. The smaller "
                 "number below is that of the worst view.",
                 table);
}

std::string dataset_table(std::span<const RunData> runs) {
  Table table{"datasets", "Length and content of the datasets", {{"dataset"}}};
  table.add_numeric(
      {"events [M]", "duration [s]", "mean depth [m]", "path length [m]", "path / depth"});
  std::set<std::string> shown;
  for (const RunData& data : runs)
    if (shown.insert(data.dataset).second) table.rows.push_back(dataset_row(data));
  return section("datasets", "Datasets",
                 "Below each number the thesis's (table 8.1) and the difference from it.", table);
}

std::string speed_table(std::span<const RunData> runs) {
  if (!has_any(runs, "speed.")) return "";
  Table table{"speed", "Time without reading and writing files", {{"run"}}};
  table.add_numeric(
      {"time [ms]", "events/s [M]", "faster by", "poses/s", "faster by", "× real time", "threads"});
  for (const RunData& data : runs)
    if (speed_value(data.metrics, "speed.wall_s")) table.rows.push_back(speed_row(data));
  return section("speed", "Speed",
                 "Medians where a run was repeated. The smaller number below is the thesis's "
                 "(table 8.3).",
                 table, thesis_protocol("speed.events_per_s"));
}

}  // namespace saccade
