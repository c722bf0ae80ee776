#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "eval/picture/view/sensor_view.h"
#include "eval/report/html.h"
#include "eval/report/sections/page_sections.h"
#include "eval/table/number_text.h"

namespace saccade {
namespace {

constexpr std::size_t kWindowSamples = 100;  // of 1 ms: shorter than a failure, longer than a jump
constexpr std::size_t kShownOfMethod = 3;
/// Limits of a loss (eval/metrics/trajectory/loss_metrics.h), which make both errors comparable.
constexpr double kLostPercent = 5, kLostDeg = 5;

/// The part of a run in which it errs most.
struct WorstWindow {
  const RunData* run = nullptr;
  double severity = 0;  ///< mean of the larger error over its limit; above 1 is lost
  double from_s = 0, until_s = 0;
  double peak_s = 0;  ///< of the largest error in it
};

std::vector<double> severities(const ErrorSeries& errors) {
  std::vector<double> values;
  for (std::size_t i = 0; i < errors.t_s.size(); ++i) {
    const double position =
        errors.dt_rel_percent.empty() ? 0 : errors.dt_rel_percent[i] / kLostPercent;
    values.push_back(std::max(position, errors.dtheta_deg[i] / kLostDeg));
  }
  return values;
}

WorstWindow worst_window(const RunData& run) {
  const std::vector<double> values = severities(run.errors);
  const std::size_t length = std::min(kWindowSamples, values.size());
  double sum = 0, largest = -1;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    sum += values[i];
    if (i >= length) sum -= values[i - length];
    if (i + 1 >= length && sum > largest) {
      largest = sum;
      begin = i + 1 - length;
    }
  }
  const auto first = values.begin() + static_cast<std::ptrdiff_t>(begin);
  const auto peak = std::max_element(first, first + static_cast<std::ptrdiff_t>(length));
  const std::vector<double>& t_s = run.errors.t_s;
  return {&run, largest / static_cast<double>(length), t_s[begin], t_s[begin + length - 1],
          t_s[static_cast<std::size_t>(peak - values.begin())]};
}

std::string caption(const WorstWindow& window) {
  const ErrorSeries& errors = window.run->errors;
  const auto at = static_cast<std::size_t>(
      std::find(errors.t_s.begin(), errors.t_s.end(), window.peak_s) - errors.t_s.begin());
  std::string error = fmt::format("{} deg", significant(errors.dtheta_deg[at]));
  if (!errors.dt_rel_percent.empty())
    error = fmt::format("{} % of the depth, ", significant(errors.dt_rel_percent[at])) + error;
  return fmt::format(
      "<a href=\"{}\">{}</a>, {:.3f} to {:.3f} s{}; drawn at {:.3f} s, where it errs by {}",
      escape_html(window.run->address), escape_html(window.run->run.name()), window.from_s,
      window.until_s, window.severity > 1 ? ", lost" : "", window.peak_s, error);
}

std::string picture_of(const WorstWindow& window) {
  const RunData& run = *window.run;
  const SensorView view(*run.data, window.peak_s, window.peak_s, {});
  const auto& map = run.keyframes ? run.keyframes->map_at(window.peak_s) : run.map;
  const ImageRgb8 picture =
      map.empty()
          ? view.events(window.peak_s)
          : view.map_over_events(window.peak_s, map, held_pose(run.input.estimate, window.peak_s));
  return figure(picture, caption(window), "map over events in a window with large errors");
}

/// The worst of each method first.
std::vector<std::pair<std::string, std::vector<WorstWindow>>> by_method(
    std::span<const RunData> runs) {
  std::vector<std::pair<std::string, std::vector<WorstWindow>>> methods;
  for (const RunData& run : runs) {
    const bool can_be_drawn =
        run.data && !run.data->events_file().empty() && !run.input.estimate.empty();
    if (!can_be_drawn || run.errors.t_s.empty()) continue;
    auto method = std::find_if(methods.begin(), methods.end(),
                               [&](const auto& item) { return item.first == run.method; });
    if (method == methods.end()) method = methods.insert(methods.end(), {run.method, {}});
    method->second.push_back(worst_window(run));
  }
  for (auto& [name, windows] : methods) {
    std::stable_sort(windows.begin(), windows.end(),
                     [](const auto& a, const auto& b) { return a.severity > b.severity; });
    windows.resize(std::min(windows.size(), kShownOfMethod));
  }
  return methods;
}

}  // namespace

std::string failure_section(std::span<const RunData> runs) {
  std::string html;
  for (const auto& [method, windows] : by_method(runs)) {
    html += fmt::format("<h3>{}</h3>\n<div class=\"grid three\">", escape_html(method));
    for (const WorstWindow& window : windows) html += picture_of(window);
    html += "</div>\n";
  }
  if (html.empty()) return "";
  return "<section id=\"failures\"><h2>Failures</h2>\n"
         "<p>Of every method the 0.1 s with the largest errors, of at most three runs: the map "
         "projected with the estimated pose, over the events. Where both part, the pose is wrong; "
         "where there are few events or edges, the reason is in the scene.</p>\n" +
         html + "</section>\n";
}

}  // namespace saccade
