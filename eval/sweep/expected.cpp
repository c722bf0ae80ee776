#include "eval/sweep/expected.h"

#include <algorithm>

namespace saccade {
namespace {

bool is_about(const ExpectedFigure& figure, const SweepPoint& point) {
  const std::vector<std::string>& datasets = figure.datasets;
  return point.configuration == figure.configuration &&
         (datasets.empty() ||
          std::find(datasets.begin(), datasets.end(), point.dataset) != datasets.end());
}

FigureVerdict judge(const ExpectedFigure& figure, const SweepGroup& group) {
  FigureVerdict verdict{&figure, group.point.dataset, std::nullopt, false};
  const std::optional<MetricSummary> summary = summarise(group, figure.metric);
  if (!summary) return verdict;
  verdict.value = summary->value;
  verdict.met = summary->count == group.rows.size() &&
                (!figure.at_most || summary->value <= *figure.at_most) &&
                (!figure.at_least || summary->value >= *figure.at_least);
  return verdict;
}

}  // namespace

std::vector<FigureVerdict> judge_expected(const SweepResults& results) {
  std::vector<FigureVerdict> verdicts;
  for (const ExpectedFigure& figure : results.sweep.expected)
    for (const SweepGroup& group : results.groups)
      if (is_about(figure, group.point)) verdicts.push_back(judge(figure, group));
  return verdicts;
}

}  // namespace saccade
