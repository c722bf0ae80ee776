#pragma once

#include <cstdint>

#include "simulator/sensor/event_options.h"
#include "simulator/sensor/pixel/event_pixel.h"

namespace saccade {

/// Least threshold of a pixel as a share of the nominal one. A draw below becomes this value, so
/// that no pixel fires without end; at sigma 0.2 that is a share of 3e-6 of the pixels, at the
/// allowed maximum 0.5 one of 28, which also raises the mean threshold by 0.7 % there.
constexpr double kLeastContrast = 0.1;

/// The thresholds of a pixel for its whole life (formula at MismatchOptions), ON and OFF drawn
/// apart.
[[nodiscard]] Contrast pixel_contrast(const EventOptions& options, std::uint64_t seed,
                                      std::uint16_t x, std::uint16_t y);

}  // namespace saccade
