#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "eval/gate/gate_run.h"

namespace saccade {

struct GateOptions {
  double tolerance =
      0.03;             ///< smallest relative change that counts, > 0; some metrics have their own
  double gross = 0.25;  ///< relative change that counts where there are fewer than six pairs, > 0
  double slower = 1.1;  ///< smallest ratio of the times that counts, > 1
  double confidence = 0.99;  ///< of all comparisons together, in (0.5, 1)
  int resamples = 10000;     ///< of the bootstrap, >= 100; more are drawn for many comparisons
  std::uint64_t seed = 1;    ///< of the resamples
  bool speed = true;         ///< also judge the time
  bool partial = false;      ///< runs of the baseline may be left out
  std::vector<std::string> metrics;  ///< judged in addition to gate_metrics()
  /// Settings in which the runs differ from the baseline on purpose (leave_out_compared()).
  std::vector<std::string> compared = {};

  /// Throws InputError that names the option of the command that is out of range.
  void check() const;
};

/// The result of one comparison.
struct GateRow {
  enum class Verdict { kRegressed, kImproved, kSame };

  Verdict verdict = Verdict::kSame;
  std::string metric;
  std::string scope;  ///< the sequence, or the module whose sequences are pooled
  std::size_t pairs = 0;
  std::optional<double> before;  ///< mean over the pairs
  std::optional<double> after;
  std::optional<double> change;  ///< relative, e.g. 0.05 for 5 % more
  std::optional<double> low;     ///< the simultaneous interval of `change`
  std::optional<double> high;
  std::optional<double> p;  ///< one-sided, in the direction of the change, corrected (Holm)
  std::string note;         ///< the reason of the verdict where it is not the interval
};

struct GateResult {
  std::vector<GateRow> rows;  ///< regressed ones first, then improved ones
  std::vector<std::string> notes;

  [[nodiscard]] std::size_t count(GateRow::Verdict verdict) const;
  [[nodiscard]] bool tripped() const { return count(GateRow::Verdict::kRegressed) > 0; }
};

/// Compares runs with the runs of the baseline that have the same keys (docs/gate.md). Equal input
/// gives an equal result. Throws InputError where no run has a partner.
[[nodiscard]] GateResult compare_runs(std::span<const GateRun> baseline,
                                      std::span<const GateRun> runs, const GateOptions& options);

/// Compares the times of two builds [s], > 0, equally many and at least one of each; first_s[i] and
/// second_s[i] were measured directly after each other.
[[nodiscard]] GateResult compare_times(std::span<const double> first_s,
                                       std::span<const double> second_s,
                                       const GateOptions& options);

/// Holm's step-down correction: p_(i) becomes max over j <= i of (m - j + 1) p_(j), at most 1; in
/// the order of the input.
[[nodiscard]] std::vector<double> holm(std::span<const double> p);

}  // namespace saccade
