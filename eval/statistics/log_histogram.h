#pragma once

#include <cstddef>
#include <vector>

namespace saccade {

/// Counts of positive values in bins of equal width on a logarithmic axis: bin i holds values from
/// lower(i) up to, but not including, lower(i + 1), where lower(i) = least * 10^(i / per_decade).
class LogHistogram {
 public:
  /// `least` > 0, `decades` and `per_decade` >= 1.
  LogHistogram(double least, int decades, int per_decade);

  /// Values outside go to the first or the last bin; 0 and less to the first.
  void add(double value);

  [[nodiscard]] std::size_t bins() const { return counts_.size(); }
  [[nodiscard]] std::size_t count(std::size_t bin) const { return counts_[bin]; }
  [[nodiscard]] double lower(std::size_t bin) const;
  /// Geometric mean of the bin's ends.
  [[nodiscard]] double middle(std::size_t bin) const;

 private:
  double least_;
  double per_decade_;
  std::vector<std::size_t> counts_;
};

}  // namespace saccade
