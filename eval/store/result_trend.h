#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "eval/store/change_points.h"
#include "eval/store/result_store.h"
#include "eval/store/result_text.h"

namespace saccade {

/// The runs of a commit in a trend.
struct TrendPoint {
  std::string commit;  ///< the version where there is none
  std::string added;   ///< of its first run, UTC
  std::size_t runs = 0;
  double mean = 0;
};

/// A metric of the same work over the commits.
struct Trend {
  std::string sequence;  ///< "walls, track best"; of a speed also the machine and its threads
  std::vector<TrendPoint> points;
  std::vector<ChangePoint> changes;
};

/// A metric over the commits that stored runs are of, in the order in which these were first added.
struct ResultTrend {
  std::string metric;  ///< as it is stored
  std::vector<Trend> trends;
};

/// Runs of one dataset, module, configuration and window are one trend; several of one commit and
/// seed give their mean. Changes smaller than the gate's tolerance (docs/gate.md) do not count.
/// InputError (`--trend`) with the nearest name where no run has the metric.
[[nodiscard]] ResultTrend result_trend(ResultReader& reader, const std::string& metric,
                                       std::string_view where = {});

/// As a table one line a commit, changes marked; CSV and JSON hold the same.
[[nodiscard]] std::string format_trend(const ResultTrend& trend, ResultFormat format);

/// A metric that differs between runs that did the same work with the same program: same commit,
/// dataset, configuration, window, seed and machine.
struct FlakyMetric {
  std::string sequence;
  std::string metric;
  std::size_t groups = 0;  ///< of runs that should agree
  std::size_t flaky = 0;   ///< groups in which they do not
  double spread = 0;       ///< largest (max - min) / |mean| of a group
};

/// The largest spread first. Speeds differ always and are left out; a group needs two runs.
/// InputError (`--flaky`) where no two runs did the same work.
[[nodiscard]] std::vector<FlakyMetric> flaky_metrics(ResultReader& reader,
                                                     std::string_view where = {});

[[nodiscard]] std::string format_flaky(const std::vector<FlakyMetric>& metrics,
                                       ResultFormat format);

}  // namespace saccade
