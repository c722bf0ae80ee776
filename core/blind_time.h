#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/event.h"
#include "core/io/events/event_file.h"

namespace saccade {

/// All times from an event of a pixel to its next, ascending [us].
[[nodiscard]] std::vector<double> event_gaps_us(std::span<const Event> events, SensorSize size);

/// The time for which a pixel is blind after an event, from the floor of the gaps.
struct BlindTime {
  /// nullopt: the gaps are too few, or have no floor.
  std::optional<double> us;
  double low_us = 0, high_us = 0;  ///< 95 % interval
  std::size_t gaps = 0;            ///< that it was found from
  /// Of all gaps, those that obey no floor: of broken pixels, or of two pixels under one address.
  double without_floor = 0;
};

/// Maximum likelihood of the shortest gaps' floor T: with t_m the longest of them,
///   p(t) = e / t_m + (1 - e) (a + 1) (t - T)^a / (t_m - T)^(a + 1)   (t > T),   e / t_m  (t <= T)
/// a >= 0 tells how the density rises from the floor (0: noise, which comes at any time; more: edges
/// that need time to pass a threshold again), e is the part of gaps that obey no floor, as those of
/// broken pixels, or of two pixels under one address. The interval is that of the profile
/// likelihood. Edges so slow that no gap comes close to T make it too long.
/// `ascending_us` > 0.
[[nodiscard]] BlindTime blind_time(std::span<const double> ascending_us);

/// The same by the events of some of the pixels [us]; 0 where no floor is seen. Edges of a bounded slope make a floor, too: half as
/// long where the image moves twice as fast, while a blind time stays the same. 0 therefore also where the floor follows the
/// rate of the events, where that hardly varies, so that the two cannot be told apart, and where successive short gaps are
/// equal, as those between interpolated frames are.
[[nodiscard]] double find_blind_time_us(std::span<const Event> events, SensorSize size);

}  // namespace saccade
