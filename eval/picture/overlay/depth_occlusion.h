#pragma once

#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/io/dataset/dataset.h"
#include "core/rigid3.h"
#include "core/trajectory.h"

namespace saccade {

/// A depth map with its pose relative to the camera whose points are tested.
struct PosedDepthMap {
  ImageF depth;          ///< z [m], 0 = nothing hit
  PinholeCamera camera;  ///< with its lens
  Rigid3 map_from_camera;
};

/// True where the first of `maps` that contains the point has a depth more than 1 % nearer; a
/// picture that touches a wall is not occluded by it. False where no map contains the point. The
/// nearest pixel is used: depths of two surfaces must not be interpolated.
[[nodiscard]] bool is_occluded(const std::vector<PosedDepthMap>& maps,
                               const Eigen::Vector3d& point_in_camera);

/// The depth maps before and after `t_s`, the nearest in time first, within the median spacing of
/// the maps; a single map counts at its own time only. `motion`: the trajectory of the camera, not
/// empty.
[[nodiscard]] std::vector<PosedDepthMap> depth_maps_near(const Dataset& dataset,
                                                         const Trajectory& motion, double t_s);

}  // namespace saccade
