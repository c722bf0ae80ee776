#pragma once

#include <functional>
#include <string>

#include "core/image.h"
#include "eval/picture/image/image_picture.h"

namespace saccade {

/// Draws a colour bar along the lower edge, from colour(0) at its left end to colour(1) at its
/// right end, with the texts above its ends.
[[nodiscard]] ImageRgb8 with_colour_bar(ImageRgb8 picture,
                                        const std::function<Rgb8(double)>& colour,
                                        const std::string& left, const std::string& right);

/// The colour bar of draw_depth(), in metres.
[[nodiscard]] ImageRgb8 with_depth_bar(ImageRgb8 picture, const DepthRange& range);

}  // namespace saccade
