#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "eval/metrics/trajectory/relative_error.h"
#include "eval/report/charts/box_plot.h"
#include "eval/report/charts/page_chart.h"
#include "eval/report/html.h"
#include "eval/report/sections/page_sections.h"

namespace saccade {
namespace {

constexpr int kPercents[] = {10, 20, 30, 40, 50};

/// Over all runs of a method on a sequence, by fraction of the path.
using MethodErrors = std::map<int, SegmentErrors>;

struct SequenceErrors {
  std::string sequence;
  std::vector<std::pair<std::string, MethodErrors>> methods;  ///< in the order of the runs
};

template <typename Items>
auto& item_of(Items& items, const std::string& name) {
  const auto found = std::find_if(items.begin(), items.end(),
                                  [&](const auto& item) { return item.first == name; });
  return found == items.end() ? items.emplace_back(name, MethodErrors{}).second : found->second;
}

std::vector<SequenceErrors> collect(std::span<const RunData> runs) {
  std::vector<SequenceErrors> sequences;
  for (const RunData& run : runs) {
    if (run.samples.t_s.empty()) continue;
    auto sequence = std::find_if(sequences.begin(), sequences.end(),
                                 [&](const auto& item) { return item.sequence == run.dataset; });
    if (sequence == sequences.end())
      sequence = sequences.insert(sequences.end(), {run.dataset, {}});
    MethodErrors& method = item_of(sequence->methods, run.method);
    for (const int percent : kPercents) {
      const SegmentErrors errors = segment_errors(run.samples, percent);
      SegmentErrors& all = method[percent];
      all.trans_percent.insert(all.trans_percent.end(), errors.trans_percent.begin(),
                               errors.trans_percent.end());
      all.rot_deg_per_m.insert(all.rot_deg_per_m.end(), errors.rot_deg_per_m.begin(),
                               errors.rot_deg_per_m.end());
    }
  }
  return sequences;
}

std::string plot_of(const SequenceErrors& sequence, std::vector<double> SegmentErrors::*errors,
                    const char* label, const MethodStyles& styles) {
  BoxPlot plot{fmt::format("{} over parts of the path on {}", label, sequence.sequence), label, {}};
  for (const int percent : kPercents) {
    BoxPlot::Group group{fmt::format("{} %", percent), {}};
    for (const auto& [method, all] : sequence.methods)
      if (const auto numbers = box_numbers(all.at(percent).*errors))
        group.boxes.push_back({method, styles.curve(method).colour, *numbers});
    if (!group.boxes.empty()) plot.groups.push_back(std::move(group));
  }
  const std::string svg = box_plot_svg(plot);
  return svg.empty() ? "" : fmt::format("<div><h4>{}</h4>{}</div>\n", escape_html(label), svg);
}

std::string legend(const SequenceErrors& sequence, const MethodStyles& styles) {
  std::string items;
  for (const auto& [method, errors] : sequence.methods)
    items += fmt::format("<li><i style=\"background:var(--{})\"></i>{}</li>",
                         styles.curve(method).colour, escape_html(method));
  return "<ul class=\"legend\">" + items + "</ul>\n";
}

}  // namespace

std::string segment_section(std::span<const RunData> runs) {
  const std::vector<SequenceErrors> sequences = collect(runs);
  std::vector<std::string> methods;
  for (const RunData& run : runs)
    if (std::find(methods.begin(), methods.end(), run.method) == methods.end())
      methods.push_back(run.method);
  const MethodStyles styles(methods);
  std::string html;
  for (const SequenceErrors& sequence : sequences) {
    const std::string plots =
        plot_of(sequence, &SegmentErrors::trans_percent, "translation [% of the part]", styles) +
        plot_of(sequence, &SegmentErrors::rot_deg_per_m, "rotation [deg/m]", styles);
    if (!plots.empty())
      html += fmt::format("<h3>{}</h3>\n<div class=\"grid\">{}</div>\n{}",
                          escape_html(sequence.sequence), plots, legend(sequence, styles));
  }
  if (html.empty()) return "";
  return "<section id=\"segments\"><h2>Relative errors over parts of the path</h2>\n"
         "<p>Over every part of the true path of 10 to 50 % of its length, all runs of a method "
         "together: "
         "median, quartiles, and the middle 90 % of the errors.</p>\n" +
         html + "</section>\n";
}

}  // namespace saccade
