#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "eval/store/result_row.h"
#include "eval/store/result_store.h"

namespace saccade {

/// The variant of each run of a sweep, by the name of its folder.
using RunVariants = std::map<std::string, std::string>;

/// What two runs that are compared have in common (of two named runs: what the first is of). The
/// window counts to a hundredth of a second.
struct PairKey {
  std::string dataset;
  std::string module;
  std::string config;  ///< empty where configurations or variants are compared
  std::string window;  ///< "0.00-2.00"; empty: the whole dataset
  std::uint64_t seed = 0;

  [[nodiscard]] auto operator<=>(const PairKey&) const = default;
};

/// A metric of both sides of a pair, NaN where it was not measured. A side with several runs of the
/// same key gives their mean.
struct MetricChange {
  double a = 0;
  double b = 0;

  [[nodiscard]] bool measured() const;  ///< on both sides
  /// 100 (b - a) / |a|; NaN where a side is not measured or a is 0 and b is not.
  [[nodiscard]] double percent() const;
};

struct ResultPair {
  PairKey key;
  std::vector<MetricChange> changes;  ///< for each metric of the diff
};

/// Two groups of runs, paired.
struct ResultDiff {
  std::string a, b;  ///< as they were named
  std::string by;    ///< what the names are: "run", "commit", "version", "config" or "variant"
  std::vector<std::string> metrics;  ///< all of the store, in alphabetical order
  std::vector<ResultPair> pairs;
  std::vector<std::string> alone;  ///< runs without a partner
};

/// Pairs the runs that `a` and `b` name among those for which `where` holds. Names are looked for
/// among the runs, the commits (also their beginnings), the versions, the configurations and the
/// variants, in this order; two runs are a pair whatever they are of. InputError with the nearest name where one
/// names nothing or nothing can be paired.
/// `variants`: names of runs by the run (run_variants()).
[[nodiscard]] ResultDiff diff_results(ResultReader& reader, const std::string& a,
                                      const std::string& b, std::string_view where = {},
                                      const RunVariants& variants = {});

/// A metric over all pairs.
struct ChangeSummary {
  std::string metric;
  std::size_t pairs = 0;  ///< where both sides are measured
  double a = 0;           ///< means over these pairs
  double b = 0;
  double median_percent = 0;  ///< NaN where no change can be stated relative to a
  std::size_t better = 0;     ///< pairs; 0 also where neither direction is better
  std::size_t worse = 0;
};
/// Of the metrics that both sides of a pair have.
[[nodiscard]] std::vector<ChangeSummary> summarise_changes(const ResultDiff& diff);

}  // namespace saccade
