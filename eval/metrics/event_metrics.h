#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/event.h"
#include "eval/metrics/metrics.h"

namespace saccade {

/// A stream of events that is compared with another.
struct ComparedEvents {
  std::span<const Event> events;         ///< in EventOrder
  std::span<const std::uint8_t> origin;  ///< EventLabels::origin of each; empty: not known
};

/// Tolerances of time at which two events may be a pair, both ends included.
struct MatchTolerance {
  TimeNs ns;
  std::string_view name;  ///< in the keys
};
constexpr std::array<MatchTolerance, 3> kMatchTolerances{
    {{1'000, "1us"}, {10'000, "10us"}, {100'000, "100us"}}};
/// The one of them by which pixels, polarities and origins are told apart.
constexpr std::size_t kMainTolerance = 1;

/// Which events of two streams are the same, pixel by pixel and polarity by polarity, one to one.
struct MatchedEvents {
  /// For each tolerance, event by event of the two streams: whether it has a partner. In the order
  /// of time each event takes the earliest that is left, which pairs as many as any matching.
  std::array<std::vector<bool>, kMatchTolerances.size()> first, second;
  /// Time differences [ns], first - second, of pairs up to 1 ms apart. The nearest are paired
  /// before those further apart, lest an event that one stream lacks shifts all that follow it.
  std::vector<TimeNs> dt_ns;
};

[[nodiscard]] MatchedEvents match_events(std::span<const Event> first,
                                         std::span<const Event> second);

/// Scores `events` against `truth` as events.* (docs/metrics.md): fractions, ratios and
/// microseconds. What cannot be measured is null: precision of no events, times without a pair.
[[nodiscard]] Metrics score_events(const ComparedEvents& events, const ComparedEvents& truth,
                                   const MatchedEvents& matched);

}  // namespace saccade
