#pragma once

#include <cstdint>

#include "simulator/scene/scene.h"

namespace saccade {

/// What a pixel sees at an instant: its log intensity, and as much of the surface as tells whether
/// two samples lie on one.
struct ViewSample {
  double t_s = 0;
  double log_intensity = 0;  ///< ln(eps + mean radiance)
  float distance = 0;        ///< z depth along the pixel's first ray; 0 = background
  float x = 0, y = 0;        ///< of the first ray on the texture, in texels of its pyramid level
  TriangleId triangle = kNothing;   ///< that the first ray sees
  std::uint32_t object = kNothing;  ///< that this belongs to
  bool is_exact = true;             ///< computed in double precision, or as good as it gets
  std::uint64_t triangles = 0;      ///< the triangle, or of several rays a hash of theirs
  std::uint64_t lights = 0;         ///< the LightSet of the ray, or of several a hash of theirs
};

}  // namespace saccade
