#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/event.h"
#include "core/io/events/event_file.h"

namespace saccade {

/// A rate with its 95 % interval [1/s].
struct CountedRate {
  double hz = 0, low_hz = 0, high_hz = 0;
  std::size_t count = 0;
};

/// Of `count` events of a Poisson process in `seconds` > 0 (Wilson and Hilferty's approximation of
/// the exact interval).
[[nodiscard]] CountedRate counted_rate(std::size_t count, double seconds);

/// Noise of a pixel, counted where and when nothing else happened.
struct NoiseRates {
  CountedRate on, off;        ///< of a pixel that is not hot
  double pixel_seconds = 0;   ///< in which they were counted
  double quiet_fraction = 0;  ///< of all pixels and times, that this is
  int reach_px = 0;           ///< no other pixel's event within this distance ...
  double reach_s = 0;         ///< ... and time
  /// Whether a neighbourhood wider than the nearest pixels was left with enough events, or much of
  /// all pixels and times is quiet; else texture is everywhere, and the rates are mostly its.
  bool is_told = false;
  struct HotPixel {
    int x = 0, y = 0;
    double hz = 0;
  };
  std::vector<HotPixel> hot;
};

/// Counts the events that come where no other pixel nearby has one, and divides them by the space and
/// time of which that can be said: noise comes there at its rate, whatever the scene does elsewhere
/// and whether the camera moves. The neighbourhood is the largest for which enough is left; weak
/// texture that only single pixels see remains in the count, so that before a moving camera the
/// rates are upper bounds. A pixel that has five events there at least, and so many that no Poisson
/// process of the median rate would give them to one pixel of the sensor, is hot and left out.
/// `events` in EventOrder, at least two at different times.
[[nodiscard]] NoiseRates noise_rates(std::span<const Event> events, SensorSize size);

}  // namespace saccade
