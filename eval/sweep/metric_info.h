#pragma once

#include <span>
#include <string>

namespace saccade {

/// How a metric is shown.
struct MetricInfo {
  enum class Better { kLower, kHigher, kNeither };

  std::string key;
  std::string label;
  Better better = Better::kLower;
  bool is_speed = false;    ///< summarised by its median; its spread says nothing of the method
  bool in_figures = false;  ///< drawn unless the sweep names its metrics
};

/// The columns of a table whose sweep names none, in their order.
[[nodiscard]] std::span<const MetricInfo> usual_metrics();

/// Of any key; one that is not among the usual ones is its own label, and an error unless its name
/// tells otherwise.
[[nodiscard]] MetricInfo metric_info(const std::string& key);

}  // namespace saccade
