#pragma once

#include <cstdint>

#include "simulator/sensor/noise/noise_options.h"

namespace saccade {

/// How fast the reference of a pixel falls [log units/s], >= 0, for its whole life (formula at
/// LeakOptions). `contrast_on`: the pixel's own threshold, so that its rate before a static scene
/// is the drawn one.
[[nodiscard]] double leak_slope(const LeakOptions& options, double contrast_on, std::uint64_t seed,
                                std::uint16_t x, std::uint16_t y);

/// The share of its period for which the leak of a pixel has been at work when a recording starts,
/// uniform in [0, 1): so leak events come at their rate from the start on.
[[nodiscard]] double leak_phase(std::uint64_t seed, std::uint16_t x, std::uint16_t y);

}  // namespace saccade
