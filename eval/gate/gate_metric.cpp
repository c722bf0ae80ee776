#include "eval/gate/gate_metric.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace saccade {

std::span<const MetricInfo> gate_metrics() {
  static const std::vector<MetricInfo> metrics = [] {
    std::vector<MetricInfo> judged;
    std::copy_if(metric_catalogue().begin(), metric_catalogue().end(), std::back_inserter(judged),
                 [](const MetricInfo& metric) { return metric.floor.has_value(); });
    return judged;
  }();
  return metrics;
}

bool is_judged_by_sign(std::string_view key) { return key.ends_with(".fit.scale"); }

std::optional<double> worsening(const MetricInfo& metric, double before, double after) {
  const double floor = metric.floor.value_or(kDefaultFloor);
  if (before + floor <= 0 || after + floor <= 0) return std::nullopt;
  const double change = std::log((after + floor) / (before + floor));
  return metric.higher_is_better() ? -change : change;
}

double relative_change(const MetricInfo& metric, double worse) {
  return std::expm1(metric.higher_is_better() ? -worse : worse);
}

}  // namespace saccade
