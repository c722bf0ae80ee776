#pragma once

#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "estimator/depth/ray_gather.h"

namespace saccade {

/// Where edges were found already, by pixel.
class FoundEdges {
 public:
  FoundEdges(const PinholeCamera& camera, float spacing_px);

  void add(const RayEdge& edge);
  /// Another edge of the same direction within the spacing, its inverse depth nearer than
  /// `tolerance`.
  [[nodiscard]] bool holds(const RayEdge& edge, float tolerance) const;

 private:
  static constexpr int kNone = -1;
  struct Found {
    RayEdge edge;
    int older;  ///< of the same pixel
  };

  Image<int> newest_;  ///< of each pixel
  std::vector<Found> edges_;
  float spacing_px_;
};

}  // namespace saccade
