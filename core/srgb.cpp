#include "core/srgb.h"

#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

const std::array<float, 256>& decode_table() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> values{};
    for (std::size_t code = 0; code < values.size(); ++code)
      values[code] = static_cast<float>(linear_from_srgb(static_cast<double>(code) / 255));
    return values;
  }();
  return table;
}

template <class To, class From, class Convert>
Image<To> converted(const Image<From>& image, Convert convert) {
  Image<To> result(image.width(), image.height());
  std::transform(image.pixels().begin(), image.pixels().end(), result.pixels().begin(), convert);
  return result;
}

}  // namespace

double linear_from_srgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

double srgb_from_linear(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

float linear_from_srgb8(std::uint8_t code) { return decode_table()[code]; }

std::uint8_t srgb8_from_linear(float linear) {
  if (!(linear > 0)) return 0;
  const double encoded = srgb_from_linear(std::min(static_cast<double>(linear), 1.0));
  return static_cast<std::uint8_t>(encoded * 255 + 0.5);
}

ImageF linear_from_srgb8(const ImageU8& codes) {
  return converted<float>(codes, [](std::uint8_t code) { return linear_from_srgb8(code); });
}

ImageU8 srgb8_from_linear(const ImageF& linear) {
  return converted<std::uint8_t>(linear, [](float value) { return srgb8_from_linear(value); });
}

ImageU8 codes_from_linear(const ImageF& linear, const ToneCurve& curve) {
  const double exponent = 1 / curve.gamma.value_or(1);
  return converted<std::uint8_t>(linear, [&](float value) -> std::uint8_t {
    const double x = curve.gain * static_cast<double>(value);
    if (!curve.gamma) return srgb8_from_linear(static_cast<float>(x));
    if (!(x > 0)) return 0;
    return static_cast<std::uint8_t>(std::pow(std::min(x, 1.0), exponent) * 255 + 0.5);
  });
}

std::array<float, 256> linear_of_codes(const ToneCurve& curve) {
  std::array<float, 256> radiance{};
  for (std::size_t code = 0; code < radiance.size(); ++code) {
    const double encoded = static_cast<double>(code) / 255;
    const double linear = curve.gamma ? std::pow(encoded, *curve.gamma) : linear_from_srgb(encoded);
    radiance[code] = static_cast<float>(linear / curve.gain);
  }
  return radiance;
}

}  // namespace saccade
