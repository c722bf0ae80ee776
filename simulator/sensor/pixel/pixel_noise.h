#pragma once

#include <cstdint>
#include <limits>

#include "simulator/sensor/event_options.h"
#include "simulator/sensor/noise/photoreceptor.h"
#include "simulator/sensor/noise/spontaneous_events.h"

namespace saccade {

/// What a pixel with imperfections remembers besides its reference: the states of the models that
/// act within it in time. Trivially copyable, without padding.
struct NoisyState {
  static constexpr double kNotRefractory = -std::numeric_limits<double>::infinity();

  double refractory_until_s = kNotRefractory;  ///< the reference is reset then
  SpontaneousState spontaneous;
  FilterState filter;

  /// Whether only a crossing of the (filtered) signal could make the pixel fire or reset it from
  /// `from_s` up to `to_s`. Every model that acts at a time of its own has its condition here.
  [[nodiscard]] bool is_idle(double from_s, double to_s) const {
    return refractory_until_s < from_s && spontaneous.next_s() >= to_s;
  }
};

/// The models that act within the pixels in time, as all pixels share them.
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

  /// The state of a pixel that has seen `log_intensity` for long at `t_s`.
  [[nodiscard]] NoisyState start(std::uint16_t x, std::uint16_t y, double log_intensity,
                                 double t_s) const {
    return {NoisyState::kNotRefractory, spontaneous.start(x, y, t_s),
            PhotoreceptorFilter::settled(log_intensity)};
  }
};

}  // namespace saccade
