#pragma once

#include <cstddef>

#include "core/image.h"
#include "core/rigid3.h"
#include "estimator/depth/depth_estimator.h"
#include "estimator/reconstruction/image_estimator.h"
#include "estimator/tracking/map_extraction.h"

namespace saccade {

/// What is known of the scene from one view: a depth map and the edges that the camera is tracked
/// by, and where it was made for people, too, an image.
struct Keyframe {
  double t_s = 0;  ///< of the view
  Rigid3 world_from_camera;
  double start_s = 0, end_s = 0;  ///< of the events that it was made from
  std::size_t events = 0;
  DepthResult depth;
  Reconstruction image;        ///< empty pictures where none was asked for
  MapPoints edges;             ///< in the world [m]
  double typical_depth_m = 1;  ///< median of the depths
};

}  // namespace saccade
