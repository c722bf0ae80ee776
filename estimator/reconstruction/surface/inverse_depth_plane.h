#pragma once

namespace saccade {

/// A pixel with a known inverse depth.
struct SurfaceAnchor {
  float x_px = 0;  ///< within half a pixel of the image
  float y_px = 0;
  float inverse_depth = 0;   ///< > 0 [1/m]
  float relative_sigma = 0;  ///< sigma of its inverse depth over it, > 0
};

/// A plane in space: its inverse depth is linear in the image.
struct InverseDepthPlane {
  float at_origin = 0;  ///< [1/m] at pixel (0, 0)
  float x = 0, y = 0;   ///< its slope [1/m per px]

  [[nodiscard]] float inverse_depth(float x_px, float y_px) const {
    return at_origin + x * x_px + y * y_px;
  }
};

}  // namespace saccade
