#pragma once

#include "core/camera.h"
#include "core/image.h"
#include "eval/picture/canvas/colour.h"

namespace saccade {

/// Linear radiance as a grey picture, exposed so that its 99.5th percentile is white.
[[nodiscard]] ImageRgb8 draw_radiance(const ImageF& radiance);

/// Depths that a picture's colours span [m], 0 < near < far.
struct DepthRange {
  double near_m = 1;
  double far_m = 2;
};

/// From the 1st to the 99th percentile of the valid (finite, > 0) depths.
[[nodiscard]] DepthRange depth_range(const ImageF& depth);

/// Depth in the ordered colours over INVERSE depth, near bright and far dark; where there is none,
/// the theme's faint colour.
[[nodiscard]] ImageRgb8 draw_depth(const ImageF& depth, const DepthRange& range,
                                   const Theme& theme);
[[nodiscard]] Rgb8 depth_colour(double depth_m, const DepthRange& range);

/// The image as the camera without distortion would see it; `outside` where it saw nothing.
[[nodiscard]] ImageF undistort_image(const ImageF& image, const PinholeCamera& camera,
                                     float outside = 0);

}  // namespace saccade
