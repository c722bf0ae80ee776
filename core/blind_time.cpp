#include "core/blind_time.h"

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
  constexpr int kSteps = 24;  // of expectation and maximisation, whose optimum is one-dimensional
  for (int step = 0; step < kSteps; ++step) {
    double responsible = 0;
    for (const double d : density)
      responsible += fraction * uniform / (fraction * uniform + (1 - fraction) * d);
    const double before = fraction;
    fraction = std::clamp(responsible / static_cast<double>(gaps.size()), 1e-4, 0.999);
    constexpr double kConverged = 1e-3;  ///< of the fraction
    if (std::abs(fraction - before) < kConverged * fraction) break;
  }
  double value = 0;
  for (const double d : density) value += std::log(fraction * uniform + (1 - fraction) * d);
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

/// Calls use(event, gap_us) for every event but the first of its pixel.
template <class Use>
void for_each_gap(std::span<const Event> events, SensorSize size, const Use& use) {
  constexpr TimeNs kNone = -1;
  Image<TimeNs> last(size.width, size.height, kNone);
  for (const Event& event : events) {
    TimeNs& before = last(event.x, event.y);
    if (before != kNone) use(event, static_cast<double>(event.t_ns - before) * 1e-3);
    before = event.t_ns;
  }
}

/// The gaps that end in one part of the time.
struct GapSlice {
  std::size_t events = 0;
  std::vector<double> gaps_us;
};

/// Equal parts of the time of the events. Without the first ones, which have gaps that began in them alone.
std::vector<GapSlice> gap_slices(std::span<const Event> events, SensorSize size) {
  constexpr std::size_t kSlices = 24, kFirst = 2;
  const TimeNs start_ns = events.front().t_ns;
  const TimeNs slice_ns = (events.back().t_ns - start_ns) / static_cast<TimeNs>(kSlices) + 1;
  std::vector<GapSlice> slices(kSlices);
  const auto slice_of = [&](const Event& event) -> GapSlice& {
    return slices[static_cast<std::size_t>((event.t_ns - start_ns) / slice_ns)];
  };
  for (const Event& event : events) ++slice_of(event).events;
  for_each_gap(events, size, [&](const Event& event, double gap_us) {
    slice_of(event).gaps_us.push_back(gap_us);
  });
  slices.erase(slices.begin(), slices.begin() + kFirst);
  return slices;
}

/// The floor of the gaps of some slices, by one gap in two hundred [us]; 0 of few gaps.
double floor_of(std::span<const GapSlice> slices) {
  constexpr std::size_t kPart = 200, kLeast = 5;
  std::vector<double> gaps;
  for (const GapSlice& slice : slices)
    gaps.insert(gaps.end(), slice.gaps_us.begin(), slice.gaps_us.end());
  if (gaps.size() < kLeast * kPart) return 0;
  const auto at = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / kPart);
  std::nth_element(gaps.begin(), at, gaps.end());
  return *at;
}

double mean_events(std::span<const GapSlice> slices) {
  double sum = 0;
  for (const GapSlice& slice : slices) sum += static_cast<double>(slice.events);
  return sum / static_cast<double>(slices.size());
}

/// Whether successive short gaps are the same, as those of a simulator that draws straight lines from frame to frame, whose
/// steepest one makes a floor: most of them are then, and of pixels that are blind one or two in a hundred.
bool has_equal_gaps(std::span<const Event> events, SensorSize size, double floor_us) {
  constexpr double kShort = 3, kSame = 0.005, kSame_us = 1.5, kMostEqual = 0.2;
  struct Pixel {
    TimeNs t_ns = 0;
    double gap_us = 0;     ///< before that
    int polarity = 0;      ///< 0: none so far
    bool is_ramp = false;  ///< both events of the gap are of one polarity
  };
  Image<Pixel> pixels(size.width, size.height);
  std::size_t pairs = 0, equal = 0;
  for (const Event& event : events) {
    Pixel& pixel = pixels(event.x, event.y);
    const bool is_ramp = event.polarity == pixel.polarity;
    const double gap_us = static_cast<double>(event.t_ns - pixel.t_ns) * 1e-3;
    if (is_ramp && pixel.is_ramp && std::max(gap_us, pixel.gap_us) < kShort * floor_us) {
      ++pairs;
      if (std::abs(gap_us - pixel.gap_us) < std::max(kSame_us, kSame * gap_us)) ++equal;
    }
    pixel = {event.t_ns, gap_us, event.polarity, is_ramp};
  }
  return static_cast<double>(equal) > kMostEqual * static_cast<double>(pairs);
}

/// Whether the floor of the gaps stays where the rate of the events varies. On generated worlds its power is 0 to 0.35 in that rate
/// where pixels are blind, and 1 where edges make it.
bool has_constant_floor(std::span<const Event> events, SensorSize size) {
  constexpr double kLeastVariation = 1.15, kMostPower = 0.5;
  if (events.empty()) return false;
  std::vector<GapSlice> slices = gap_slices(events, size);
  std::ranges::sort(slices, {}, &GapSlice::events);
  const auto slow = std::span<const GapSlice>(slices).first(slices.size() / 3);
  const auto fast = std::span<const GapSlice>(slices).last(slices.size() / 3);
  const double variation = mean_events(fast) / std::max(mean_events(slow), 1.0);
  const double slow_floor = floor_of(slow), fast_floor = floor_of(fast);
  return variation > kLeastVariation && slow_floor > 0 && fast_floor > 0 &&
         std::log(slow_floor / fast_floor) < kMostPower * std::log(variation) &&
         !has_equal_gaps(events, size, fast_floor);
}

}  // namespace

std::vector<double> event_gaps_us(std::span<const Event> events, SensorSize size) {
  std::vector<double> gaps;
  for_each_gap(events, size, [&](const Event&, double gap_us) { gaps.push_back(gap_us); });
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

double find_blind_time_us(std::span<const Event> events, SensorSize size) {
  // The floor is seen in a few thousand gaps.
  constexpr std::size_t kEnoughEvents = 250'000;
  const auto step = static_cast<int>(events.size() / kEnoughEvents) + 1;
  Events some;
  for (const Event& event : events)
    if ((event.y * size.width + event.x) % step == 0) some.push_back(event);
  if (!has_constant_floor(some, size)) return 0;
  return blind_time(event_gaps_us(some, size)).us.value_or(0);
}

}  // namespace saccade
