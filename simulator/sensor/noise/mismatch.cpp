#include "simulator/sensor/noise/mismatch.h"

#include <algorithm>

#include "core/random.h"
#include "simulator/sensor/noise/pixel_random.h"

namespace saccade {

Contrast pixel_contrast(const EventOptions& options, std::uint64_t seed, std::uint16_t x,
                        std::uint16_t y) {
  const MismatchOptions& mismatch = options.noise.mismatch;
  if (!mismatch.on()) return options.contrast;
  const Random random(seed);
  const std::uint64_t stream = noise_stream(NoiseStream::kMismatch, x, y);
  const auto factor = [&](std::uint64_t index) {
    return std::max(kLeastContrast, 1 + mismatch.sigma * random.normal(stream, index));
  };
  return {options.contrast.on * factor(0), options.contrast.off * factor(1)};
}

}  // namespace saccade
