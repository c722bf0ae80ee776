#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "eval/statistics/log_histogram.h"

namespace saccade {

/// Times between one event of a pixel and its next.
struct EventGaps {
  LogHistogram same;      ///< next of the same polarity [us]
  LogHistogram opposite;  ///< next of the other polarity [us]
  double opposite_fraction = 0;
  double shortest_us = 0;
  /// One gap in a thousand is shorter: the blind time, where it shows. This and the median are
  /// counted in bins, and are right to 0.03 %.
  double floor_us = 0;
  double median_us = 0;  ///< these four are 0 where no pixel has two events
};

/// How the events are spread over the pixels.
struct PixelRates {
  std::vector<double> ascending_hz;  ///< events/s of every pixel
  double silent_fraction = 0;        ///< of the pixels, without any event
  /// Pixels with at least 10 events and more than five times as many as the neighbours' median + 1.
  std::size_t hot_pixels = 0;
};

/// Noise, as far as it can be told from a recording of a moving camera.
struct NoiseSigns {
  /// Fraction of events with none in the eight neighbouring pixels within 5 ms before or after.
  double isolated_fraction = 0;
  double isolated_hz = 0;  ///< of a pixel, mean
  /// Mean rates of a pixel in the quietest tenth of all blocks of 10 x 10 pixels [1/s]: an upper
  /// end of the noise where textureless parts stay in view, but counts of a short recording scatter
  /// and the choice of the quietest favours low ones.
  double quiet_on_hz = 0;
  double quiet_off_hz = 0;
};

/// Rates of a part of the recording.
struct RateBin {
  double t_s = 0;  ///< begin, from the first event on
  double on_hz = 0;
  double off_hz = 0;
};

/// Statistics that a stream of events has whatever made it, so that a simulation can be held
/// against a recording (docs/realism.md).
struct StreamStatistics {
  std::string name = {};  ///< of the recording; StreamCounter leaves it empty
  std::size_t events = 0;
  double duration_s = 0;     ///< first to last event
  double pixel_rate_hz = 0;  ///< events/s of a pixel, mean
  double on_fraction = 0;
  std::vector<RateBin> rates;  ///< of consecutive bins; the last one, not full, is left out
  EventGaps gaps;
  PixelRates pixels;
  NoiseSigns noise;
};

}  // namespace saccade
