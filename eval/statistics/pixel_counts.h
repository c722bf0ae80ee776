#pragma once

#include <cstddef>

#include "core/image.h"
#include "eval/statistics/stream_statistics.h"

namespace saccade {

/// Events of each pixel, by polarity.
struct PixelCounts {
  Image<std::size_t> on, off;

  [[nodiscard]] std::size_t at(int x, int y) const { return on(x, y) + off(x, y); }
};

/// How the counts of `duration_s` are spread over the pixels.
[[nodiscard]] PixelRates pixel_rates(const PixelCounts& counts, double duration_s);

/// NoiseSigns::quiet_on_hz and quiet_off_hz, nothing else; 0 on a sensor without a whole block.
[[nodiscard]] NoiseSigns quiet_rates(const PixelCounts& counts, double duration_s);

}  // namespace saccade
