#include "simulator/sensor/pixel/pixel_traits.h"

#include "simulator/sensor/noise/leak.h"
#include "simulator/sensor/noise/mismatch.h"

namespace saccade {

PixelTraits pixel_traits(const EventOptions& options, std::uint64_t seed, std::uint16_t x,
                         std::uint16_t y) {
  const LeakOptions& leak = options.noise.leak;
  const Contrast contrast = pixel_contrast(options, seed, x, y);
  const double slope = leak_slope(leak, contrast.on, seed, x, y);
  const double period_s = slope > 0 ? contrast.on / slope : 0;
  return {x, y, contrast, slope, leak_phase(seed, x, y) * period_s};
}

PixelState start_pixel(const PixelTraits& traits, double log_intensity, double t_s) {
  const double since_s = t_s - traits.leaking_s;
  return {EventPixel(log_intensity + traits.drift_per_s * since_s, traits.contrast), since_s};
}

}  // namespace saccade
