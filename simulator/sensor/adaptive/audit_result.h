#pragma once

#include <cstdint>

namespace saccade {

/// A measured figure with its 95 % confidence interval.
struct AuditFigure {
  double value = 0;
  double low = 0, high = 0;
};

/// How the events of a sampled camera agree with the exact ones of the same pixels: one-to-one per
/// pixel and polarity, in order, within a tolerance.
///   precision: matched / sampled,   recall: matched / exact
struct AuditResult {
  std::uint64_t pixels = 0;  ///< audited; 0: no audit
  std::uint64_t exact_events = 0;
  std::uint64_t sampled_events = 0;
  AuditFigure precision_10us, recall_10us;
  AuditFigure precision_1us, recall_1us;
  AuditFigure p99_dt_us;  ///< 99th percentile of |dt| of what is matched within 1 ms
};

}  // namespace saccade
