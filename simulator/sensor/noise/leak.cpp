#include "simulator/sensor/noise/leak.h"

#include <algorithm>

#include "core/random.h"
#include "simulator/sensor/noise/pixel_random.h"

namespace saccade {

double leak_slope(const LeakOptions& options, double contrast_on, std::uint64_t seed,
                  std::uint16_t x, std::uint16_t y) {
  if (!options.on()) return 0;
  const double z = Random(seed).normal(noise_stream(NoiseStream::kLeak, x, y), 0);
  return contrast_on * options.rate_hz * std::max(0.0, 1 + options.sigma * z);
}

}  // namespace saccade
