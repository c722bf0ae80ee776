#include "eval/report/sections/module_sections.h"

#include <filesystem>
#include <span>
#include <vector>

#include "core/io/trajectory_file.h"
#include "core/time_search.h"
#include "eval/picture/chart/line_chart.h"
#include "eval/report/html.h"

namespace saccade {
namespace {

constexpr std::size_t kMostPoints = 300;
constexpr const char* kTitles[] = {"about x [rad/s]", "about y [rad/s]", "about z [rad/s]"};

/// Times from 0 on, which keeps their axis linear.
std::vector<LineChart::Point> line(std::span<const StampedTwist> rates, int axis, double start_s) {
  const std::size_t every = (rates.size() + kMostPoints - 1) / kMostPoints;
  std::vector<LineChart::Point> points;
  for (std::size_t i = 0; i < rates.size(); i += every) {
    const double value = rates[i].angular_velocity[axis];
    points.push_back({rates[i].t_s - start_s, {value, value, value}});
  }
  return points;
}

/// Those between the first and the last estimate.
std::span<const StampedTwist> during(std::span<const StampedTwist> truth,
                                     const std::vector<StampedTwist>& estimate) {
  const std::size_t first = count_before(truth, estimate.front().t_s, &StampedTwist::t_s);
  const std::size_t end = count_before(truth, estimate.back().t_s, &StampedTwist::t_s);
  return truth.subspan(first, end - first);
}

}  // namespace

std::string rotation_section(const RunData& data) {
  const std::filesystem::path file = data.run.folder / "angular_velocity.txt";
  if (!std::filesystem::exists(file)) return "";
  const std::vector<StampedTwist> estimate = read_angular_velocities(file);
  if (estimate.empty()) return "";
  std::vector<StampedTwist> truth;
  if (data.data && std::filesystem::exists(data.data->folder() / "twist.txt"))
    truth = data.data->load_twists();
  const std::span<const StampedTwist> shown = during(truth, estimate);
  const double start_s = estimate.front().t_s;
  LineChart chart;
  chart.x_label = "time since the first estimate [s]";
  if (!shown.empty()) chart.names.emplace_back("truth");
  chart.names.emplace_back("estimate");
  for (int axis = 0; axis < 3; ++axis) {
    LineChart::Panel panel{kTitles[axis], {}};
    if (!shown.empty()) panel.lines.push_back(line(shown, axis, start_s));
    panel.lines.push_back(line(estimate, axis, start_s));
    chart.panels.push_back(std::move(panel));
  }
  return "<h4>Angular velocity</h4>" +
         figure(draw(chart, kLightTheme), "In camera axes", "angular velocity over time");
}

}  // namespace saccade
