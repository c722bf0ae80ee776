#pragma once

#include "core/image.h"

namespace saccade {

/// Log intensity as grey from `low` (black) to `high` (white). Pixels that `observed` (may be
/// empty) marks with 0 are tinted.
[[nodiscard]] ImageRgb8 draw_log_image(const ImageF& log_image, const ImageU8& observed, float low,
                                       float high);

/// The error of log intensity that pictures of it draw as bright as they can.
inline constexpr float kMaxLogError = 0.5F;

/// A quantity from 0 (dark) to `max` (bright) in the ordered colours, where `mask` is not 0.
[[nodiscard]] ImageRgb8 draw_magnitude(const ImageF& image, const ImageU8& mask, float max);

/// The value below which `share` of the values on the mask lie; 0 where the mask is empty.
[[nodiscard]] float quantile(const ImageF& image, const ImageU8& mask, double share);

}  // namespace saccade
