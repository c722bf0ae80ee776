#include "eval/sweep/result/expectations.h"

#include <algorithm>

namespace saccade {
namespace {

bool is_about(const ExpectedMetric& figure, const SweepPoint& point) {
  const std::vector<std::string>& datasets = figure.datasets;
  return point.configuration == figure.configuration &&
         (datasets.empty() ||
          std::find(datasets.begin(), datasets.end(), point.dataset) != datasets.end());
}

ExpectationResult judge(const ExpectedMetric& figure, const SweepGroup& group) {
  ExpectationResult verdict{&figure, group.point.dataset, std::nullopt, false};
  const std::optional<MetricSummary> summary = summarise(group, figure.metric);
  if (!summary) return verdict;
  verdict.value = summary->value;
  verdict.met = summary->count == group.rows.size() &&
                (!figure.at_most || summary->value <= *figure.at_most) &&
                (!figure.at_least || summary->value >= *figure.at_least);
  return verdict;
}

}  // namespace

std::vector<ExpectationResult> check_expectations(const SweepResults& results) {
  std::vector<ExpectationResult> verdicts;
  for (const ExpectedMetric& figure : results.sweep.expected)
    for (const SweepGroup& group : results.groups)
      if (is_about(figure, group.point)) verdicts.push_back(judge(figure, group));
  return verdicts;
}

}  // namespace saccade
