#pragma once

#include <cstdint>

#include "simulator/scene/scene.h"

namespace saccade {

/// What a pixel sees at an instant: its log intensity, and as much of the surface as tells whether
/// two samples lie on one.
struct ViewSample {
  double t_s = 0;
  double radiance = 0;             ///< mean of all rays
  double log_intensity = 0;        ///< ln(eps + radiance)
  double distance = 0;             ///< z depth along the pixel's first ray; 0 = background
  double x = 0, y = 0;             ///< of the first ray on the texture [texel]
  double level = 0;                ///< of the texture's pyramid
  double factor = 1;               ///< of the first ray: multiplies the texture
  double irradiance = 1;           ///< where the first ray ends
  double mirrored = 0;             ///< likewise: radiance that a glossy surface adds
  TriangleId triangle = kNothing;  ///< that the first ray sees
  std::uint64_t triangles = 0;     ///< a hash of those of all rays
  std::uint64_t lights = 0;        ///< a hash of the lights that light all of them
  LightSet lights_of_ray = 0;      ///< that light the first
  LightSet settled = 0;  ///< lights of which it is known in double precision whether they do
  double normal_x = 0, normal_y = 0;  ///< of the first ray on a normal map [texel]
  double normal_level = 0;            ///< of its pyramid
};

}  // namespace saccade
