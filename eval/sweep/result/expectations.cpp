#include "eval/sweep/result/expectations.h"

#include <algorithm>

namespace saccade {
namespace {

bool applies_to(const ExpectedMetric& expected, const SweepPoint& point) {
  const std::vector<std::string>& datasets = expected.datasets;
  return point.configuration == expected.configuration &&
         (datasets.empty() ||
          std::find(datasets.begin(), datasets.end(), point.dataset) != datasets.end());
}

ExpectationResult check(const ExpectedMetric& expected, const SweepGroup& group) {
  ExpectationResult result{&expected, group.point.dataset, std::nullopt, false};
  const std::optional<MetricSummary> summary = summarise(group, expected.metric);
  if (!summary) return result;
  result.value = summary->value;
  result.met = summary->count == group.rows.size() &&
               (!expected.at_most || summary->value <= *expected.at_most) &&
               (!expected.at_least || summary->value >= *expected.at_least);
  return result;
}

}  // namespace

std::vector<ExpectationResult> check_expectations(const SweepResults& results) {
  std::vector<ExpectationResult> found;
  for (const ExpectedMetric& expected : results.sweep.expected)
    for (const SweepGroup& group : results.groups)
      if (applies_to(expected, group.point)) found.push_back(check(expected, group));
  return found;
}

}  // namespace saccade
