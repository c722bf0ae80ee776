#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/image.h"

namespace saccade {

/// The sRGB transfer curve (IEC 61966-2-1), exact and piecewise; encoded and linear both in [0, 1].
[[nodiscard]] double linear_from_srgb(double encoded);
[[nodiscard]] double srgb_from_linear(double linear);

/// The same for 8-bit codes. Linear light is clamped to [0, 1] (NaN to 0) and the nearest code
/// taken, so every code survives the round trip.
[[nodiscard]] float linear_from_srgb8(std::uint8_t code);
[[nodiscard]] std::uint8_t srgb8_from_linear(float linear);

[[nodiscard]] ImageF linear_from_srgb8(const ImageU8& codes);
[[nodiscard]] ImageU8 srgb8_from_linear(const ImageF& linear);

/// How a camera turns linear radiance into 8-bit codes: 255 curve(gain * radiance), clamped.
struct ToneCurve {
  double gain = 1;              ///< radiance 1 / gain is white
  std::optional<double> gamma;  ///< curve(x) = x^(1 / gamma); none: the sRGB curve
};

[[nodiscard]] ImageU8 codes_from_linear(const ImageF& linear, const ToneCurve& curve);

/// The radiance that each 8-bit code stands for: the inverse of the above but for its rounding and
/// clamping.
[[nodiscard]] std::array<float, 256> linear_of_codes(const ToneCurve& curve);

/// Luminance of linear RGB (ITU-R BT.709).
[[nodiscard]] constexpr float luminance(float r, float g, float b) {
  return 0.2126F * r + 0.7152F * g + 0.0722F * b;
}

}  // namespace saccade
