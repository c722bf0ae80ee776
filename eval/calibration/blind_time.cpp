#include "eval/calibration/blind_time.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/image.h"

namespace saccade {
namespace {

/// With fewer gaps a floor and chance look alike.
constexpr std::size_t kLeastGaps = 50;
/// Of the gaps, the part that the floor is found from: enough to see it rise, and few enough that
/// one power law describes that. More only where most of the shortest ones obey no floor.
constexpr double kParts[] = {0.05, 0.12, 0.3};
constexpr std::size_t kMostFloorGaps = 2000;
constexpr double kMostWithoutFloor = 0.4;
constexpr int kFloors = 240;
constexpr std::array<double, 5> kRises{0, 0.5, 1, 1.5, 2};
/// Half of the 95 % quantile of chi-square with one degree of freedom.
constexpr double kLikelihoodDrop = 1.92;

struct FloorFit {
  double log_likelihood = -1e300;
  double without_floor = 1;  ///< fraction of the gaps
};

/// The likeliest fraction of gaps without a floor.
FloorFit fit_fraction(std::span<const double> gaps, double floor, double rise) {
  const double longest = gaps.back();
  const double uniform = 1 / longest;
  const double scale = (rise + 1) / std::pow(longest - floor, rise + 1);
  std::vector<double> density(gaps.size(), 0.0);
  for (std::size_t i = 0; i < gaps.size(); ++i)
    if (gaps[i] > floor) density[i] = scale * std::pow(gaps[i] - floor, rise);
  double fraction = 0.02;
  double value = 0;
  constexpr int kSteps = 25;  // of expectation and maximisation, whose optimum is one-dimensional
  for (int step = 0; step < kSteps; ++step) {
    double responsible = 0;
    value = 0;
    for (const double d : density) {
      const double all = fraction * uniform + (1 - fraction) * d;
      responsible += fraction * uniform / all;
      value += std::log(all);
    }
    fraction = std::clamp(responsible / static_cast<double>(gaps.size()), 1e-4, 0.999);
  }
  return {value, fraction};
}

/// The likeliest fits of every floor from 0 to the longest gap.
std::array<FloorFit, kFloors> fit_floors(std::span<const double> gaps) {
  std::array<FloorFit, kFloors> fits;
  for (int k = 0; k < kFloors; ++k)
    for (const double rise : kRises) {
      const FloorFit fit = fit_fraction(gaps, gaps.back() * k / kFloors, rise);
      FloorFit& best = fits[static_cast<std::size_t>(k)];
      if (fit.log_likelihood > best.log_likelihood) best = fit;
    }
  return fits;
}

/// Every n-th of the gaps, so that at most kMostFloorGaps are left.
std::vector<double> thinned(std::span<const double> gaps) {
  const std::size_t stride = gaps.size() / kMostFloorGaps + 1;
  std::vector<double> some;
  for (std::size_t i = stride - 1; i < gaps.size(); i += stride) some.push_back(gaps[i]);
  return some;
}

}  // namespace

std::vector<double> event_gaps_us(std::span<const Event> events, SensorSize size) {
  constexpr TimeNs kNone = -1;
  Image<TimeNs> last(size.width, size.height, kNone);
  std::vector<double> gaps;
  for (const Event& event : events) {
    TimeNs& before = last(event.x, event.y);
    if (before != kNone) gaps.push_back(static_cast<double>(event.t_ns - before) * 1e-3);
    before = event.t_ns;
  }
  std::sort(gaps.begin(), gaps.end());
  return gaps;
}

BlindTime blind_time(std::span<const double> ascending_us) {
  BlindTime result;
  if (ascending_us.size() < kLeastGaps) return result;
  std::vector<double> gaps;
  std::array<FloorFit, kFloors> fits;
  const FloorFit* best = nullptr;
  double part = 0;
  for (const double next : kParts) {
    part = next;
    const auto wanted = static_cast<std::size_t>(part * static_cast<double>(ascending_us.size()));
    gaps = thinned(ascending_us.first(std::max(wanted, kLeastGaps)));
    fits = fit_floors(gaps);
    best = &*std::ranges::max_element(fits, {}, &FloorFit::log_likelihood);
    if (best->without_floor < kMostWithoutFloor) break;
  }
  result.gaps = gaps.size();
  result.without_floor = part * best->without_floor;
  // A floor that hardly any gap obeys is none.
  const auto is_likely = [&](const FloorFit& fit) {
    return fit.log_likelihood > best->log_likelihood - kLikelihoodDrop &&
           (&fit == fits.data() || fit.without_floor < kMostWithoutFloor);
  };
  const auto low = std::find_if(fits.begin(), fits.end(), is_likely);
  if (low == fits.end()) return result;
  const auto high = std::find_if(fits.rbegin(), fits.rend(), is_likely);
  const auto floor_at = [&](std::ptrdiff_t k) {
    return gaps.back() * static_cast<double>(k) / kFloors;
  };
  result.low_us = floor_at(low - fits.begin());
  result.high_us = floor_at(kFloors - (high - fits.rbegin()));
  // No floor at all is as likely.
  if (low == fits.begin() || best->without_floor >= kMostWithoutFloor) return result;
  result.us = floor_at(best - fits.data());
  return result;
}

}  // namespace saccade
