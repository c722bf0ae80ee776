#pragma once

#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/io/dataset.h"
#include "core/rigid3.h"
#include "core/trajectory.h"

namespace saccade {

/// A depth map as a judge of what stands before a point.
struct PosedDepthMap {
  ImageF depth;          ///< z [m], 0 = nothing hit
  PinholeCamera camera;  ///< with its lens
  Rigid3 view_from_camera;
};

/// True where the first of `views` that has the point in its image sees something nearer there, by
/// more than 1 %; a picture that touches a wall is not hidden by it. False where none sees the
/// point. The nearest pixel decides: between two surfaces there is no depth to interpolate.
[[nodiscard]] bool is_occluded(const std::vector<PosedDepthMap>& views,
                             const Eigen::Vector3d& point_in_camera);

/// The depth maps before and after `t_s`, the nearest in time first, as far as they are not further
/// away than the usual (median) spacing of the maps; a single map counts at its own time only.
/// `motion`: the camera's, which carries a point at `t_s` over to the time of a map; not empty.
[[nodiscard]] std::vector<PosedDepthMap> depth_maps_near(const Dataset& dataset,
                                                      const Trajectory& motion, double t_s);

}  // namespace saccade
