#include "simulator/sensor/noise/mismatch.h"

#include <algorithm>

#include "core/config/fields.h"
#include "core/random.h"
#include "simulator/sensor/noise/pixel_random.h"
#include "simulator/sensor/pixel/pixel_traits.h"

namespace saccade {

void describe(config::Fields& fields, MismatchOptions& options) {
  fields
      .value(
          "sigma", options.sigma,
          "Standard deviation of the pixels' thresholds, as a fraction of the nominal threshold. "
          "0 gives all pixels the same thresholds.")
      .range(0, 0.5);
}

Contrast pixel_contrast(const MismatchOptions& options, const Contrast& nominal, std::uint64_t seed,
                        std::uint16_t x, std::uint16_t y) {
  if (!options.on()) return nominal;
  const Random random(seed);
  const std::uint64_t stream = noise_stream(NoiseStream::kMismatch, x, y);
  const auto factor = [&](std::uint64_t index) {
    return std::max(kLeastContrast, 1 + options.sigma * random.normal(stream, index));
  };
  return {nominal.on * factor(0), nominal.off * factor(1)};
}

void apply_mismatch(const MismatchOptions& options, std::uint64_t seed, PixelTraits& traits) {
  traits.contrast = pixel_contrast(options, traits.contrast, seed, traits.x, traits.y);
}

}  // namespace saccade
