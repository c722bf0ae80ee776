#include "eval/picture/image/log_picture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "eval/picture/canvas/colour.h"

namespace saccade {
namespace {

constexpr Rgb8 kUnobserved{70, 90, 190};

}  // namespace

ImageRgb8 draw_log_image(const ImageF& log_image, const ImageU8& observed, float low, float high) {
  const float range = std::max(high - low, 1e-6F);
  ImageRgb8 picture(log_image.width(), log_image.height());
  for (std::size_t i = 0; i < log_image.size(); ++i) {
    const float fraction = std::clamp((log_image.pixels()[i] - low) / range, 0.0F, 1.0F);
    const auto code = static_cast<std::uint8_t>(std::lround(255 * fraction));
    const Rgb8 grey{code, code, code};
    const bool is_observed = observed.empty() || observed.pixels()[i] != 0;
    picture.pixels()[i] = is_observed ? grey : mix(grey, kUnobserved, 0.5);
  }
  return picture;
}

ImageRgb8 draw_magnitude(const ImageF& image, const ImageU8& mask, float max) {
  ImageRgb8 picture(image.width(), image.height(), kDarkTheme.faint);
  for (std::size_t i = 0; i < image.size(); ++i)
    if (mask.empty() || mask.pixels()[i] != 0)
      picture.pixels()[i] =
          ordered_colour(static_cast<double>(image.pixels()[i] / std::max(max, 1e-9F)));
  return picture;
}

float quantile(const ImageF& image, const ImageU8& mask, double fraction) {
  std::vector<float> values;
  for (std::size_t i = 0; i < image.size(); ++i)
    if (mask.empty() || mask.pixels()[i] != 0) values.push_back(image.pixels()[i]);
  if (values.empty()) return 0;
  const auto at = values.begin() +
                  static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace saccade
