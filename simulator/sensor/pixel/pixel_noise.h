#pragma once

#include <limits>

#include "simulator/sensor/event_options.h"
#include "simulator/sensor/noise/photoreceptor.h"
#include "simulator/sensor/noise/spontaneous_events.h"

namespace saccade {

/// The imperfections within the pixels, as all pixels share them.
struct PixelNoise {
  double refractory_s;
  SpontaneousEvents spontaneous;
  PhotoreceptorFilter filter;

  PixelNoise(const EventOptions& options, std::uint64_t seed)
      : refractory_s(1e-6 * options.noise.refractory.period_us),
        spontaneous(options.noise, options.log_eps, seed),
        filter(options.noise.bandwidth, options.log_eps) {}

  /// Whether a pixel needs a NoisyState.
  [[nodiscard]] bool on() const { return refractory_s > 0 || spontaneous.on() || filter.on(); }
};

/// What a pixel with imperfections remembers besides its reference. Trivially copyable, without
/// padding.
struct NoisyState {
  static constexpr double kNotRefractory = -std::numeric_limits<double>::infinity();

  double refractory_until_s =
      kNotRefractory;  ///< its refractory period's end, when the reference is reset
  SpontaneousState spontaneous;
  FilterState filter;
};

}  // namespace saccade
