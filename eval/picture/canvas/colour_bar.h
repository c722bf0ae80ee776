#pragma once

#include <functional>
#include <string>

#include "core/image.h"
#include "eval/picture/image/image_picture.h"

namespace saccade {

/// Writes a bar of colours along the lower edge, `colour` of 0 at its left end and of 1 at its
/// right, with what the two mean above.
[[nodiscard]] ImageRgb8 with_colour_bar(ImageRgb8 picture,
                                        const std::function<Rgb8(double)>& colour,
                                        const std::string& left, const std::string& right);

/// The colours of draw_depth(), in metres.
[[nodiscard]] ImageRgb8 with_depth_bar(ImageRgb8 picture, const DepthRange& range);

}  // namespace saccade
