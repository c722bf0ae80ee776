#include "eval/picture/canvas/colour.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/srgb.h"

namespace saccade {
namespace {

/// OKLab (Ottosson 2020) to 8-bit sRGB, out-of-gamut channels clipped.
Rgb8 rgb_from_oklab(double lightness, double a, double b) {
  const auto code = [](double linear) { return srgb8_from_linear(static_cast<float>(linear)); };
  const auto cube = [](double x) { return x * x * x; };
  const double l = cube(lightness + 0.3963377774 * a + 0.2158037573 * b);
  const double m = cube(lightness - 0.1055613458 * a - 0.0638541728 * b);
  const double s = cube(lightness - 0.0894841775 * a - 1.2914855480 * b);
  return {code(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
          code(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
          code(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

}  // namespace

Rgb8 ordered_colour(double value) {
  const double t = value > 0 ? std::min(value, 1.0) : 0.0;
  const double lightness = 0.22 + 0.72 * t;
  // From violet over blue and green to yellow; least chroma where the gamut is narrowest.
  const double hue = (300 - 195 * t) * std::numbers::pi / 180;
  const double chroma = 0.11 + 0.05 * t * t;
  return rgb_from_oklab(lightness, chroma * std::cos(hue), chroma * std::sin(hue));
}

Rgb8 mix(const Rgb8& a, const Rgb8& b, double weight) {
  Rgb8 result;
  for (std::size_t i = 0; i < 3; ++i)
    result[i] = static_cast<std::uint8_t>(std::lround(a[i] + weight * (b[i] - a[i])));
  return result;
}

}  // namespace saccade
