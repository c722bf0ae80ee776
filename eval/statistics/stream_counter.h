#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "core/event.h"
#include "core/io/events/event_file.h"
#include "eval/statistics/stream_statistics.h"

namespace saccade {

constexpr double kRateBin_s = 0.005;  ///< shows single saccades and their turns

/// Gathers StreamStatistics from events that come span by span. Its memory grows with the sensor
/// and with the number of rate bins, not with the events.
class StreamCounter {
 public:
  /// `size`: of the sensor; without one it is as large as the events ask for. `rate_bin_s` >= 1 ns.
  explicit StreamCounter(SensorSize size = {}, double rate_bin_s = kRateBin_s);
  ~StreamCounter();
  StreamCounter(StreamCounter&&) noexcept;
  StreamCounter& operator=(StreamCounter&&) noexcept;

  /// `events` in EventOrder, none before one that was added earlier, inside the size (contract).
  void add(std::span<const Event> events);

  /// Of all that was added: at least two events at different times (contract).
  [[nodiscard]] StreamStatistics statistics() &&;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Of events in memory: as StreamCounter.
[[nodiscard]] StreamStatistics stream_statistics(std::span<const Event> events, SensorSize size,
                                                 double rate_bin_s = kRateBin_s);

}  // namespace saccade
