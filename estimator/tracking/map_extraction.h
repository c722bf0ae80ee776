#pragma once

#include <cstddef>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/rigid3.h"

namespace saccade {

/// Which pixels of the reference frame become map points (thesis section 4.4).
struct MapOptions {
  double min_gradient = 0.1;  ///< g_min
  /// 0.12: the template of a denser map costs more than the alignment.
  double max_fraction = 0.12;
  /// Keep only maxima across the edge (non-maximum suppression), for maps of estimated gradients.
  bool thin = false;
  /// An edge at a depth discontinuity moves with the nearer surface; the thesis takes the pixel's
  /// own depth.
  bool foreground_depth = true;
};

/// Map points in the camera frame of the reference view, structure of arrays [m].
struct MapPoints {
  std::vector<float> x, y, z;  ///< z > 0

  [[nodiscard]] std::size_t size() const { return x.size(); }
};

/// Puts the points of `more` behind those of `all`.
void append(MapPoints& all, const MapPoints& more);

/// The points in another frame.
[[nodiscard]] MapPoints transformed(const Rigid3& target_from_source, const MapPoints& points);

/// Thresholds the gradient magnitude of `log_intensity` (normalised by its maximum) and lifts every
/// pixel above with a valid depth into 3-D. `depth` [m], same size, 0 or NaN = unknown. `camera` is
/// undistorted. NaN in `log_intensity` marks pixels that the lens does not show. The result may be
/// empty.
[[nodiscard]] MapPoints extract_map(const ImageF& log_intensity, const ImageF& depth,
                                    const PinholeCamera& camera, const MapOptions& options);

/// The same from a gradient [1/px] that is already known; 0 where it is not.
[[nodiscard]] MapPoints lift_edges(const ImageF& gradient_x, const ImageF& gradient_y,
                                   const ImageF& depth, const PinholeCamera& camera,
                                   const MapOptions& options);

}  // namespace saccade
