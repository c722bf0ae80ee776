#include "eval/statistics/log_histogram.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace saccade {

LogHistogram::LogHistogram(double least, int decades, int per_decade)
    : least_(least),
      per_decade_(per_decade),
      counts_(static_cast<std::size_t>(decades) * static_cast<std::size_t>(per_decade)) {
  SACCADE_CHECK(least > 0 && decades >= 1 && per_decade >= 1);
}

double LogHistogram::lower(std::size_t bin) const {
  return least_ * std::pow(10.0, static_cast<double>(bin) / per_decade_);
}

double LogHistogram::middle(std::size_t bin) const {
  return least_ * std::pow(10.0, (static_cast<double>(bin) + 0.5) / per_decade_);
}

void LogHistogram::add(double value) {
  const double last = static_cast<double>(counts_.size() - 1);
  // Rounding of the logarithm must not put a bin's own lower end below it.
  const double bin = std::floor(std::log10(std::max(value, least_) / least_) * per_decade_ + 1e-9);
  ++counts_[static_cast<std::size_t>(std::clamp(bin, 0.0, last))];
}

}  // namespace saccade
