#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/image.h"

namespace saccade {

/// A convex polygon, a disc, a stroke or a leaf of one grey level that covers what was drawn before
/// it.
struct TextureShape {
  Eigen::Vector2f center = Eigen::Vector2f::Zero();  ///< [texel]
  float reach = 0;  ///< radius of a circle that contains the shape [texel]
  float log_albedo = 0;
  float opacity = 1;  ///< 0..1
  /// Of each side: outward unit normal and distance from the centre [texel]. Without sides the
  /// shape is a disc, of radius `reach`, or a stroke around the segment center -+ half_axis, or a
  /// leaf whose tips are there.
  std::vector<Eigen::Vector3f> sides;
  Eigen::Vector2f half_axis = Eigen::Vector2f::Zero();
  float half_width = 0;  ///< of a disc, a stroke or a leaf's middle [texel]
  float arc_radius = 0;  ///< of the two borders of a leaf [texel]; 0: no leaf
};

/// Draws the shapes in their order, with borders that blend over `edge` texels. Parallel over rows;
/// the result does not depend on the number of threads.
void draw_shapes(ImageF& image, const std::vector<TextureShape>& shapes, float edge);

}  // namespace saccade
