#pragma once

#include <cstdint>

namespace saccade {
namespace config {
class Fields;
}
struct PixelTraits;

/// The reset switch leaks, so the reference falls at C_on rate and a static scene gives ON events
/// (Nozaki and Delbruck, IEEE T-ED 64(8), 2017):
///   rate_p = rate_hz max(0, 1 + sigma z),   z ~ N(0, 1), one draw per pixel
struct LeakOptions {
  double rate_hz = 0;
  double sigma = 0;

  [[nodiscard]] bool on() const { return rate_hz > 0; }
};
void describe(config::Fields& fields, LeakOptions& options);

/// How fast the reference of a pixel falls [log units/s], >= 0, for its whole life (formula at
/// LeakOptions). `contrast_on`: the pixel's own threshold, so that its rate before a static scene
/// is the drawn one.
[[nodiscard]] double leak_slope(const LeakOptions& options, double contrast_on, std::uint64_t seed,
                                std::uint16_t x, std::uint16_t y);

/// The fraction of its period for which the leak of a pixel has acted when a recording starts,
/// uniform in [0, 1): so leak events come at their rate from the start on.
[[nodiscard]] double leak_phase(std::uint64_t seed, std::uint16_t x, std::uint16_t y);

/// Hook of noise_models(): sets the drift and the time for which the reference has leaked. Comes
/// after the mismatch, because the slope depends on the pixel's own ON threshold.
void apply_leak(const LeakOptions& options, std::uint64_t seed, PixelTraits& traits);

}  // namespace saccade
