#pragma once

#include "core/image.h"

namespace saccade {

/// Log intensity as grey from `low` (black) to `high` (white). Pixels that `observed` (may be
/// empty) marks with 0 are tinted.
[[nodiscard]] ImageRgb8 draw_log_image(const ImageF& log_image, const ImageU8& observed, float low,
                                       float high);

/// The error of log intensity at the bright end of the colour scale of error pictures.
inline constexpr float kMaxLogError = 0.5F;

/// A quantity from 0 (dark) to `max` (bright) in the ordered colours, where `mask` is not 0.
[[nodiscard]] ImageRgb8 draw_magnitude(const ImageF& image, const ImageU8& mask, float max);

/// The quantile of the values on the mask; 0 where the mask is empty.
[[nodiscard]] float quantile(const ImageF& image, const ImageU8& mask, double fraction);

}  // namespace saccade
