#include "simulator/sensor/noise/spontaneous_events.h"

#include <cmath>

#include "core/check.h"
#include "core/config/fields.h"
#include "simulator/sensor/noise/noise_options.h"
#include "simulator/sensor/noise/pixel_random.h"
#include "simulator/sensor/noise/radiance.h"

namespace saccade {

void describe(config::Fields& fields, ShotOptions& options) {
  fields
      .value(
          "rate_hz", options.rate_hz,
          "Rate of the shot noise events of a pixel at radiance 0, ON and OFF together, in events "
          "per second; it falls linearly to a quarter at radiance 1 and stays there above. 0 "
          "disables shot noise.")
      .range(0, kMaxNoiseRate_hz);
}

void describe(config::Fields& fields, HotOptions& options) {
  fields.value("fraction", options.fraction, "Fraction of the pixels that are hot. 0 disables it.")
      .range(0, 1);
  fields
      .value("rate_hz", options.rate_hz,
             "Median rate of the ON events of a hot pixel, in events per second. 0 disables it.")
      .range(0, kMaxNoiseRate_hz);
  fields
      .value("sigma", options.sigma,
             "Standard deviation of the natural logarithm of the hot pixels' rates.")
      .range(0, 1);
}

SpontaneousEvents::SpontaneousEvents(const NoiseOptions& options, double log_eps,
                                     std::uint64_t seed)
    : shot_(options.shot), hot_(options.hot), log_eps_(log_eps), random_(seed) {}

double SpontaneousEvents::gap_s(std::uint64_t stream, std::uint64_t index, double rate_hz) const {
  return -std::log1p(-random_.uniform(stream, 2 * index)) / rate_hz;
}

double SpontaneousEvents::hot_rate_hz(std::uint16_t x, std::uint16_t y) const {
  if (!hot_.on()) return 0;
  const std::uint64_t stream = noise_stream(NoiseStream::kHotPixel, x, y);
  if (random_.uniform(stream, 0) >= hot_.fraction) return 0;
  return hot_.rate_hz * std::exp(hot_.sigma * random_.normal(stream, 1));
}

SpontaneousState SpontaneousEvents::start(std::uint16_t x, std::uint16_t y, double t_s) const {
  SpontaneousState state;
  if (shot_.on())
    state.next_shot_s = t_s + gap_s(noise_stream(NoiseStream::kShot, x, y), 0, shot_.rate_hz);
  if (const double rate_hz = hot_rate_hz(x, y); rate_hz > 0)
    state.next_hot_s = t_s + gap_s(noise_stream(NoiseStream::kHotEvents, x, y), 0, rate_hz);
  return state;
}

SpontaneousCandidate SpontaneousEvents::next_candidate(SpontaneousState& state, std::uint16_t x,
                                                       std::uint16_t y) const {
  SACCADE_CHECK(std::isfinite(state.next_s()));
  if (state.next_hot_s < state.next_shot_s) {
    const double t = state.next_hot_s;
    const std::uint64_t stream = noise_stream(NoiseStream::kHotEvents, x, y);
    state.next_hot_s += gap_s(stream, ++state.hots, hot_rate_hz(x, y));
    return {t, 1, 0, EventOrigin::kHot};
  }
  const double t = state.next_shot_s;
  const std::uint64_t stream = noise_stream(NoiseStream::kShot, x, y);
  const double mark = 2 * random_.uniform(stream, 2 * state.shots + 1);
  state.next_shot_s += gap_s(stream, ++state.shots, shot_.rate_hz);
  return {t, mark < 1 ? 1 : -1, mark < 1 ? mark : mark - 1, EventOrigin::kShot};
}

double SpontaneousEvents::shot_rate_hz(double log_intensity) const {
  const double brightness =
      std::min(1.0, radiance_from_log(log_intensity, log_eps_) / shot_.bright_radiance);
  return shot_.rate_hz * (1 - (1 - shot_.bright_fraction) * brightness);
}

bool SpontaneousEvents::accepts(const SpontaneousCandidate& candidate, double log_intensity) const {
  if (candidate.origin == EventOrigin::kHot) return true;
  return candidate.thinning * shot_.rate_hz < shot_rate_hz(log_intensity);
}

}  // namespace saccade
