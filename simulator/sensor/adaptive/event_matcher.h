#pragma once

#include <array>
#include <cstdint>
#include <deque>

#include "core/event.h"
#include "simulator/sensor/noise/state_bytes.h"

namespace saccade {

/// Of two streams of event times and how they match.
struct MatchCounts {
  static constexpr std::size_t kTolerances = 3;
  /// The last one also bounds the time errors that are counted.
  static constexpr std::array<TimeNs, kTolerances> kTolerance_ns = {1'000, 10'000, 1'000'000};
  /// Bins of |dt|: eight in an octave from 1 ns on, to 1 ms.
  static constexpr std::size_t kBins = 8 * 20 + 1;

  std::uint64_t exact = 0;
  std::uint64_t sampled = 0;
  std::array<std::uint64_t, kTolerances> matched{};
  std::array<std::uint32_t, kBins> dt{};

  void add(const MatchCounts& other);
  [[nodiscard]] static std::size_t bin_of(TimeNs dt_ns);
  /// The upper end of a bin [us].
  [[nodiscard]] static double dt_us(std::size_t bin);
};

/// Matches the events of one pixel and polarity of two streams while they come in: the earliest
/// two are a pair where they are within the tolerance of each other; else the earlier one has no
/// partner.
class EventMatcher {
 public:
  void add_exact(TimeNs t_ns);
  void add_sampled(TimeNs t_ns);
  /// No event before `t_ns` follows in either stream: counts what that decides.
  void advance(TimeNs t_ns, MatchCounts& counts);

  void save(StateWriter& state) const;
  void load(StateReader& state);

 private:
  struct Streams {
    std::deque<TimeNs> exact, sampled;
  };
  std::array<Streams, MatchCounts::kTolerances> open_;  ///< one pair for each tolerance
};

}  // namespace saccade
