#pragma once

#include <cstdint>

#include "simulator/sensor/event_options.h"
#include "simulator/sensor/pixel/event_pixel.h"

namespace saccade {

/// What distinguishes a pixel from the others for its whole life.
struct PixelTraits {
  std::uint16_t x = 0, y = 0;
  Contrast contrast;
  double drift_per_s = 0;  ///< of the signal against the leaking reference [1/s]
  double leaking_s = 0;    ///< for how long the reference has leaked when a recording starts
};

/// What every pixel remembers. Trivially copyable, without padding.
struct PixelState {
  EventPixel reference;
  double reference_s = 0;  ///< since when the reference is what it is
};

[[nodiscard]] PixelTraits pixel_traits(const EventOptions& options, std::uint64_t seed,
                                       std::uint16_t x, std::uint16_t y);

/// Of a pixel that has seen `log_intensity` for long at `t_s`. Its reference is that intensity, but
/// for what the leak has done to it since the pixel last fired.
[[nodiscard]] PixelState start_pixel(const PixelTraits& traits, double log_intensity, double t_s);

}  // namespace saccade
