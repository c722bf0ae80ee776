#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/check.h"

namespace saccade {

/// Counts of positive values in bins of equal width on a logarithmic axis: bin i holds values from
/// lower(i) up to, but not including, lower(i + 1), where lower(i) = least * 10^(i / per_decade).
class LogHistogram {
 public:
  /// `least` > 0, `decades` and `per_decade` >= 1.
  LogHistogram(double least, int decades, int per_decade)
      : least_(least),
        per_decade_(per_decade),
        counts_(static_cast<std::size_t>(decades) * static_cast<std::size_t>(per_decade)) {
    SACCADE_CHECK(least > 0 && decades >= 1 && per_decade >= 1);
  }

  /// Values outside go to the first or the last bin; 0 and less to the first.
  void add(double value) {
    const double last = static_cast<double>(counts_.size() - 1);
    // Rounding of the logarithm must not put a bin's own lower end below it.
    const double bin =
        std::floor(std::log10(std::max(value, least_) / least_) * per_decade_ + 1e-9);
    ++counts_[static_cast<std::size_t>(std::clamp(bin, 0.0, last))];
  }

  /// The bin of the value at place `rank`, from 0 for the least on; the last bin beyond them all.
  [[nodiscard]] std::size_t bin_of_rank(std::size_t rank) const {
    std::size_t bin = 0;
    for (std::size_t below = counts_[0]; below <= rank && bin + 1 < counts_.size();)
      below += counts_[++bin];
    return bin;
  }

  [[nodiscard]] std::size_t bins() const { return counts_.size(); }
  [[nodiscard]] std::size_t count(std::size_t bin) const { return counts_[bin]; }
  [[nodiscard]] double lower(std::size_t bin) const {
    return least_ * std::pow(10.0, static_cast<double>(bin) / per_decade_);
  }
  /// Geometric mean of the bin's ends.
  [[nodiscard]] double middle(std::size_t bin) const {
    return least_ * std::pow(10.0, (static_cast<double>(bin) + 0.5) / per_decade_);
  }

 private:
  double least_;
  double per_decade_;
  std::vector<std::size_t> counts_;
};

}  // namespace saccade
