#include "simulator/sensor/noise/leak.h"

#include <algorithm>

#include "core/config/fields.h"
#include "core/random.h"
#include "simulator/sensor/noise/pixel_random.h"
#include "simulator/sensor/pixel/pixel_traits.h"

namespace saccade {
namespace {

/// The draws of a pixel's stream.
constexpr std::uint64_t kSlope = 0;
constexpr std::uint64_t kPhase = 1;

}  // namespace

void describe(config::Fields& fields, LeakOptions& options) {
  fields
      .value("rate_hz", options.rate_hz,
             "Mean rate of the ON events that the leaking reference of a pixel causes before a "
             "static scene, in events per second. 0 disables the leak.")
      .range(0, kMaxNoiseRate_hz);
  fields
      .value("sigma", options.sigma,
             "Standard deviation of the pixels' leak rates, as a fraction of rate_hz.")
      .range(0, 1);
}

double leak_slope(const LeakOptions& options, double contrast_on, std::uint64_t seed,
                  std::uint16_t x, std::uint16_t y) {
  if (!options.on()) return 0;
  const double z = Random(seed).normal(noise_stream(NoiseStream::kLeak, x, y), kSlope);
  return contrast_on * options.rate_hz * std::max(0.0, 1 + options.sigma * z);
}

double leak_phase(std::uint64_t seed, std::uint16_t x, std::uint16_t y) {
  return Random(seed).uniform(noise_stream(NoiseStream::kLeak, x, y), kPhase);
}

void apply_leak(const LeakOptions& options, std::uint64_t seed, PixelTraits& traits) {
  traits.drift_per_s = leak_slope(options, traits.contrast.on, seed, traits.x, traits.y);
  const double period_s = traits.drift_per_s > 0 ? traits.contrast.on / traits.drift_per_s : 0;
  traits.leaking_s = leak_phase(seed, traits.x, traits.y) * period_s;
}

}  // namespace saccade
