#include "eval/report/sections/page_sections.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "eval/metrics/trajectory/reliability.h"

namespace saccade {
namespace {

/// Fewer instants [ms] in a bin say nothing of how often its poses are right.
constexpr double kLeastInstants = 20;

ChartCurve reliability_curve(ChartCurve curve, const ReliabilityBins& bins) {
  for (const ReliabilityBin& bin : bins)
    if (bin.instants >= kLeastInstants)
      curve.points.add(five_digits(100 * bin.predicted / bin.instants),
                       five_digits(100 * bin.good / bin.instants));
  return curve;
}

}  // namespace

std::string reliability_section(std::span<const RunData> runs, std::vector<PageChart>& page) {
  std::vector<std::string> methods;
  std::vector<ReliabilityBins> bins;
  for (const RunData& run : runs) {
    const auto known = std::find(methods.begin(), methods.end(), run.method);
    const auto index = static_cast<std::size_t>(known - methods.begin());
    if (known == methods.end()) {
      methods.push_back(run.method);
      bins.emplace_back();
    }
    add_reliability(run.input, run.errors, bins[index]);
  }
  const MethodStyles styles(methods);
  PageChart chart{"reliability",
                  "Share of the time that is not lost, over the stated probability",
                  "reliability of the stated probabilities",
                  {"stated probability [%]", false, std::pair{0.0, 100.0}},
                  {"not lost [% of the time]", false, std::pair{0.0, 100.0}},
                  {}};
  for (std::size_t i = 0; i < methods.size(); ++i) {
    ChartCurve curve = reliability_curve(styles.curve(methods[i]), bins[i]);
    if (!curve.points.x.empty()) chart.curves.push_back(std::move(curve));
  }
  if (chart.curves.empty()) return "";
  ChartCurve ideal{"as stated", "muted", true};
  ideal.points.add(0, 0);
  ideal.points.add(100, 100);
  chart.curves.push_back(std::move(ideal));
  return "<section id=\"reliability\"><h2>Reliability</h2>\n"
         "<p>How often poses of about one stated probability are within 5 % of the mean depth and "
         "5 degrees, over the time of all runs of a method. Below the diagonal a method is too "
         "sure of its poses, above it too cautious.</p>\n" +
         chart_grid({chart}, page) + "</section>\n";
}

}  // namespace saccade
