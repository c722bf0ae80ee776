#include "tests/support/allan.h"

#include <cmath>
#include <vector>

#include "core/check.h"

namespace saccade::testing {

double allan_deviation(std::span<const double> samples, double dt_s, std::size_t m) {
  SACCADE_CHECK(m >= 1 && 2 * m <= samples.size());
  std::vector<double> theta(samples.size() + 1, 0.0);
  // A constant changes nothing but the rounding.
  for (std::size_t k = 0; k < samples.size(); ++k)
    theta[k + 1] = theta[k] + dt_s * (samples[k] - samples[0]);
  double sum = 0;
  const std::size_t terms = theta.size() - 2 * m;
  for (std::size_t k = 0; k < terms; ++k) {
    const double step = theta[k + 2 * m] - 2 * theta[k + m] + theta[k];
    sum += step * step;
  }
  const double tau = static_cast<double>(m) * dt_s;
  return std::sqrt(sum / (2 * tau * tau * static_cast<double>(terms)));
}

double log_slope(std::span<const double> x, std::span<const double> y) {
  SACCADE_CHECK(x.size() == y.size() && x.size() >= 2);
  const auto n = static_cast<double>(x.size());
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double u = std::log(x[i]);
    const double v = std::log(y[i]);
    sx += u;
    sy += v;
    sxx += u * u;
    sxy += u * v;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

}  // namespace saccade::testing
