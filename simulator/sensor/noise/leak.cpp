#include "simulator/sensor/noise/leak.h"

#include <algorithm>

#include "core/random.h"
#include "simulator/sensor/noise/pixel_random.h"

namespace saccade {
namespace {

/// The draws of a pixel's stream.
constexpr std::uint64_t kSlope = 0;
constexpr std::uint64_t kPhase = 1;

}  // namespace

double leak_slope(const LeakOptions& options, double contrast_on, std::uint64_t seed,
                  std::uint16_t x, std::uint16_t y) {
  if (!options.on()) return 0;
  const double z = Random(seed).normal(noise_stream(NoiseStream::kLeak, x, y), kSlope);
  return contrast_on * options.rate_hz * std::max(0.0, 1 + options.sigma * z);
}

double leak_phase(std::uint64_t seed, std::uint16_t x, std::uint16_t y) {
  return Random(seed).uniform(noise_stream(NoiseStream::kLeak, x, y), kPhase);
}

}  // namespace saccade
