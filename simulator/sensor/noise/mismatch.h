#pragma once

#include <cstdint>

#include "simulator/sensor/pixel/event_pixel.h"

namespace saccade {
namespace config {
class Fields;
}
struct PixelTraits;

/// Contrast thresholds that differ from pixel to pixel (fixed-pattern noise):
///   C_p = C max(kLeastContrast, 1 + sigma z),   z ~ N(0, 1), one draw per pixel and polarity
/// Measured by Lichtsteiner et al. (JSSC 43(2), 2008) and Brandli et al. (JSSC 49(10), 2014);
/// Gaussian as in v2e (Hu et al., CVPRW 2021).
struct MismatchOptions {
  double sigma = 0;

  [[nodiscard]] bool on() const { return sigma > 0; }
};
void describe(config::Fields& fields, MismatchOptions& options);

/// Least threshold of a pixel as a fraction of the nominal one. A smaller draw becomes this value,
/// so that no pixel fires without end; at sigma 0.2 that is a fraction of 3e-6 of the pixels, at
/// the allowed maximum 0.5 one of 28, which also raises the mean threshold by 0.7 % there.
constexpr double kLeastContrast = 0.1;

/// The thresholds of a pixel for its whole life (formula at MismatchOptions), ON and OFF drawn
/// apart.
[[nodiscard]] Contrast pixel_contrast(const MismatchOptions& options, const Contrast& nominal,
                                      std::uint64_t seed, std::uint16_t x, std::uint16_t y);

/// Hook of noise_models(): replaces the nominal thresholds in `traits`.
void apply_mismatch(const MismatchOptions& options, std::uint64_t seed, PixelTraits& traits);

}  // namespace saccade
