#include "simulator/sensor/adaptive/event_matcher.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

namespace saccade {
namespace {

constexpr double kBinsPerOctave = 8;

void save_times(const std::deque<TimeNs>& times, StateWriter& state) {
  state.values(std::vector<TimeNs>(times.begin(), times.end()));
}

void load_times(std::deque<TimeNs>& times, StateReader& state) {
  std::vector<TimeNs> values;
  state.values(values);
  times.assign(values.begin(), values.end());
}

}  // namespace

void MatchCounts::add(const MatchCounts& other) {
  exact += other.exact;
  sampled += other.sampled;
  for (std::size_t k = 0; k < kTolerances; ++k) matched[k] += other.matched[k];
  for (std::size_t k = 0; k < kBins; ++k) dt[k] += other.dt[k];
}

std::size_t MatchCounts::bin_of(TimeNs dt_ns) {
  if (dt_ns <= 1) return 0;
  const auto bin =
      static_cast<std::size_t>(std::ceil(kBinsPerOctave * std::log2(static_cast<double>(dt_ns))));
  return std::min(bin, kBins - 1);
}

double MatchCounts::dt_us(std::size_t bin) {
  return 1e-3 * std::exp2(static_cast<double>(bin) / kBinsPerOctave);
}

void EventMatcher::add_exact(TimeNs t_ns) {
  for (Streams& streams : open_) streams.exact.push_back(t_ns);
}

void EventMatcher::add_sampled(TimeNs t_ns) {
  for (Streams& streams : open_) streams.sampled.push_back(t_ns);
}

void EventMatcher::advance(TimeNs t_ns, MatchCounts& counts) {
  constexpr std::size_t kLast = MatchCounts::kTolerances - 1;
  for (std::size_t k = 0; k < open_.size(); ++k) {
    auto& [exact, sampled] = open_[k];
    const TimeNs tolerance_ns = MatchCounts::kTolerance_ns[k];
    while (!exact.empty() && !sampled.empty()) {
      const TimeNs dt_ns = sampled.front() - exact.front();
      if (std::abs(dt_ns) <= tolerance_ns) {
        ++counts.matched[k];
        if (k == kLast) ++counts.dt[MatchCounts::bin_of(std::abs(dt_ns))];
      }
      if (dt_ns <= tolerance_ns) sampled.pop_front();
      if (dt_ns >= -tolerance_ns) exact.pop_front();
    }
    const auto drop = [&](std::deque<TimeNs>& alone) {
      while (!alone.empty() && alone.front() + tolerance_ns < t_ns) alone.pop_front();
    };
    drop(exact);
    drop(sampled);
  }
}

void EventMatcher::save(StateWriter& state) const {
  for (const Streams& streams : open_) {
    save_times(streams.exact, state);
    save_times(streams.sampled, state);
  }
}

void EventMatcher::load(StateReader& state) {
  for (Streams& streams : open_) {
    load_times(streams.exact, state);
    load_times(streams.sampled, state);
  }
}

}  // namespace saccade
