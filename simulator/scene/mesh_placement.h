#pragma once

#include <Eigen/Geometry>

#include "simulator/scene/mesh/mesh.h"
#include "simulator/scene/scene_options.h"

namespace saccade {

/// Where `options` puts the mesh: scale (or size) along the axes of the file, then its up axis to
/// +z, then R = Rz Ry Rx, then the anchor to the translation. A side of the bounding box without
/// extent keeps its size.
[[nodiscard]] Eigen::Affine3d world_from_mesh(const MeshOptions& options, const Mesh& mesh);

}  // namespace saccade
