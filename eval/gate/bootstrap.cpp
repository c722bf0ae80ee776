#include "eval/gate/bootstrap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/check.h"
#include "core/median.h"
#include "core/random.h"

namespace saccade {
namespace {

/// Draws one resample with replacement. `number` identifies it, so that it depends neither on the
/// order of the calls nor on the thread.
void resample(const Random& random, std::uint64_t number, std::span<const double> values,
              std::vector<double>& drawn) {
  const std::uint64_t size = values.size();
  drawn.resize(values.size());
  for (std::size_t i = 0; i < drawn.size(); i += 4) {
    const std::array<std::uint32_t, 4> bits = random.bits(number, i / 4);
    for (std::size_t j = i; j < std::min(i + 4, drawn.size()); ++j)
      drawn[j] = values[static_cast<std::size_t>((bits[j - i] * size) >> 32)];
  }
}

/// The mean and its standard error.
std::pair<double, double> mean_and_error(std::span<const double> values) {
  const auto n = static_cast<double>(values.size());
  double sum = 0;
  for (const double value : values) sum += value;
  const double mean = sum / n;
  double squares = 0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return {mean, std::sqrt(squares / (n - 1) / n)};
}

/// The quantile 1 - tail.
double upper_quantile(const std::vector<double>& sorted, double tail) {
  const auto beyond = static_cast<std::size_t>(tail * static_cast<double>(sorted.size() + 1));
  return sorted[sorted.size() - std::max<std::size_t>(beyond, 1)];
}

/// The quantile `tail`.
double lower_quantile(const std::vector<double>& sorted, double tail) {
  const auto beyond = static_cast<std::size_t>(tail * static_cast<double>(sorted.size() + 1));
  return sorted[std::max<std::size_t>(beyond, 1) - 1];
}

/// t* of all resamples, sorted. The sums are of differences from the mean, so that a single pass is
/// accurate enough.
std::vector<double> studentised(std::span<const double> values, double mean,
                                const ResampleOptions& options) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Random random(options.seed);
  const auto n = static_cast<double>(values.size());
  std::vector<double> centred(values.begin(), values.end()), drawn, t;
  for (double& value : centred) value -= mean;
  t.reserve(static_cast<std::size_t>(options.resamples));
  for (int i = 0; i < options.resamples; ++i) {
    resample(random, static_cast<std::uint64_t>(i), centred, drawn);
    double sum = 0, squares = 0;
    for (const double value : drawn) {
      sum += value;
      squares += value * value;
    }
    const double variance = (squares - sum * sum / n) / (n - 1);
    t.push_back(variance > 0 ? sum / std::sqrt(n * variance) : std::copysign(kInfinity, sum));
  }
  std::sort(t.begin(), t.end());
  return t;
}

void check_options(const ResampleOptions& options) {
  SACCADE_CHECK(options.resamples >= 100 && options.tail > 0 && options.tail < 0.5);
}

}  // namespace

BootstrapMean bootstrap_mean(std::span<const double> values, const ResampleOptions& options) {
  check_options(options);
  SACCADE_CHECK(values.size() >= kLeastForBootstrap);
  for (const double value : values) SACCADE_CHECK(std::isfinite(value));
  const auto [mean, error] = mean_and_error(values);
  const double least = 1.0 / (options.resamples + 1.0);
  // Equal values differ by rounding alone.
  if (error <= 1e-12 * std::abs(mean))
    return {mean, mean, mean, mean > 0 ? least : 1, mean < 0 ? least : 1};
  const std::vector<double> t = studentised(values, mean, options);
  const double observed = mean / error;
  const auto above = t.end() - std::lower_bound(t.begin(), t.end(), observed);
  const auto below = std::upper_bound(t.begin(), t.end(), observed) - t.begin();
  return {mean, mean - error * upper_quantile(t, options.tail),
          mean - error * lower_quantile(t, options.tail), (1 + static_cast<double>(above)) * least,
          (1 + static_cast<double>(below)) * least};
}

BootstrapRatio bootstrap_paired_ratio(std::span<const double> of, std::span<const double> to,
                                      const ResampleOptions& options) {
  check_options(options);
  SACCADE_CHECK(!of.empty() && of.size() == to.size());
  for (const std::span<const double> values : {of, to})
    for (const double value : values) SACCADE_CHECK(std::isfinite(value) && value > 0);
  std::vector<double> ratios, drawn, medians;
  for (std::size_t i = 0; i < of.size(); ++i) ratios.push_back(of[i] / to[i]);
  const Random random(options.seed);
  for (int i = 0; i < options.resamples; ++i) {
    resample(random, static_cast<std::uint64_t>(i), ratios, drawn);
    medians.push_back(median(drawn));
  }
  std::sort(medians.begin(), medians.end());
  return {median(ratios), lower_quantile(medians, options.tail),
          upper_quantile(medians, options.tail)};
}

}  // namespace saccade
