#include "simulator/sensor/pixel/pixel_traits.h"

#include "simulator/sensor/noise/noise_models.h"

namespace saccade {

PixelTraits pixel_traits(const EventOptions& options, std::uint64_t seed, std::uint16_t x,
                         std::uint16_t y) {
  PixelTraits traits{x, y, options.contrast};
  for (const NoiseModel& model : noise_models())
    if (model.shape_pixel != nullptr && model.is_on(options.noise))
      model.shape_pixel(options.noise, seed, traits);
  return traits;
}

PixelState start_pixel(const PixelTraits& traits, double log_intensity, double t_s) {
  const double since_s = t_s - traits.leaking_s;
  return {EventPixel(log_intensity + traits.drift_per_s * since_s, traits.contrast), since_s};
}

}  // namespace saccade
