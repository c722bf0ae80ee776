#pragma once

#include <cstddef>
#include <limits>

#include "core/camera.h"
#include "core/image.h"
#include "core/rigid3.h"
#include "estimator/depth/depth_estimator.h"
#include "estimator/reconstruction/image_solver.h"
#include "estimator/tracking/map_extraction.h"

namespace saccade {

/// The scene as of one view: a depth map, the edges that the camera is tracked by and, where it was
/// asked for, an image.
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

/// Moves a keyframe, with its edges, to another pose.
void move_to(const Rigid3& world_from_camera, Keyframe& keyframe);

/// The points of a depth map whose relative sigma is below `max_sigma`, in the world of its view's
/// pose. `camera` is undistorted.
[[nodiscard]] MapPoints points_in_world(const DepthResult& depth, const PinholeCamera& camera,
                                        const Rigid3& world_from_camera,
                                        double max_sigma = std::numeric_limits<double>::infinity());

}  // namespace saccade
