#pragma once

#include <filesystem>
#include <vector>

#include "core/camera.h"
#include "core/event.h"
#include "core/image.h"
#include "core/spline/spline.h"

namespace saccade::testing {

/// An event as the closed form gives it.
struct ExactEvent {
  double t_s = 0;
  int x = 0;
  int y = 0;
  int polarity = 1;
};

/// A plane at z = `distance_m` that fills the view, whose texture is a float image, and a camera
/// that looks along +z (x right, y down) and moves parallel to it at constant velocity. Every pixel
/// then runs along a straight line through the texture, on which the bilinear interpolant is a
/// quadratic per texel cell, so all crossings of ln(eps + I) have a closed form.
struct ClosedFormPlane {
  PinholeCamera camera;
  ImageF texture;  ///< linear radiance; texel (i, j) at ((i, j) - centre) * metres_per_texel
  double metres_per_texel = 1.0 / 32;  ///< a power of two survives single precision
  double distance_m = 2;               ///< likewise
  Eigen::Vector2d start{0, 0};         ///< camera position at time 0 [m]
  Eigen::Vector2d velocity{0, 0};      ///< [m/s]
  double duration_s = 1;

  /// A camera of `width` x `height` px before a sum of eight plane waves of 8 texels and longer,
  /// which moves oblique to the texel grid.
  [[nodiscard]] static ClosedFormPlane smooth(int width, int height);

  /// Writes plane.obj, plane.mtl and plane.exr and returns the path of the mesh.
  [[nodiscard]] std::filesystem::path write_mesh(const std::filesystem::path& folder) const;
  [[nodiscard]] Spline motion() const;

  /// Texel coordinates that pixel (x, y) sees at time `t_s`.
  [[nodiscard]] Eigen::Vector2d texel(double x, double y, double t_s) const;

  /// Events of the ideal pixel over the whole duration, pixel by pixel, each in order of time.
  [[nodiscard]] std::vector<ExactEvent> events(double contrast_on, double contrast_off,
                                               double log_eps) const;
};

/// Events of one stream matched one-to-one with the closed form, per pixel in order.
struct ExactMatch {
  std::size_t expected = 0;
  std::size_t found = 0;
  /// Pixels whose sequences of polarities differ; their events are not timed.
  std::size_t wrong_pixels = 0;
  double median_us = 0;  ///< of |dt|
  double p99_us = 0;
  double max_us = 0;
};
[[nodiscard]] ExactMatch match_exact(const std::vector<ExactEvent>& expected, const Events& found,
                                     int width, int height);

}  // namespace saccade::testing
