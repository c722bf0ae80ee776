#pragma once

#include <optional>

#include "core/image.h"
#include "core/io/dataset/dataset.h"
#include "core/rigid3.h"

namespace saccade {

/// The true view of a camera without distortion at one instant.
struct DepthTruth {
  ImageF depth;              ///< z [m], 0 = unknown: nothing hit, or hidden from all maps used
  ImageU8 edges;             ///< 1 where |grad L| >= 0.1 per px and depth is known
  bool has_edges = false;    ///< false where the dataset has no frames with depth
  Rigid3 world_from_camera;  ///< true pose
};

/// The depth at `t_s` from its true pose: the two depth maps nearest in time are warped as
/// surfaces, triangles between neighbouring pixels with 1 / z linear in the image (exact on
/// planes), the nearest surface in front; the second map fills what is hidden from the first.
/// Neighbours whose depths differ by more than 10 % are not connected. Edges come from the grey
/// frame nearest in time, warped by the depth map at its own time. The scene is taken for
/// static. nullopt where the dataset lacks depth maps or the ground truth pose at that time.
[[nodiscard]] std::optional<DepthTruth> depth_truth_at(const Dataset& dataset, double t_s);

/// One depth map warped to another pose, see above. `depth`: z [m] on the sensor of `camera` with
/// its lens; the result has its size and no distortion.
[[nodiscard]] ImageF warp_depth(const ImageF& depth, const PinholeCamera& camera,
                                const Rigid3& target_from_source);

}  // namespace saccade
