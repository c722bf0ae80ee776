#pragma once

#include <Eigen/Geometry>

#include "simulator/scene/mesh/mesh.h"
#include "simulator/scene/world/sheet_cutter.h"

namespace saccade {

// Primitive surfaces around the origin with texture coordinates that neither stretch nor shear what
// they show, but for spheres, where they stretch it by at most 1.8. The materials that their
// triangles name come later (World). Lengths are in metres.

/// `size`: along x, y and z.
[[nodiscard]] Mesh box_mesh(const Eigen::Vector3d& size, SheetCutter& cutter);
/// Along z, from -height / 2 to height / 2, with both ends.
[[nodiscard]] Mesh cylinder_mesh(double radius, double height, int sides, SheetCutter& cutter);
/// The base at z = -height / 2, the tip at height / 2.
[[nodiscard]] Mesh cone_mesh(double radius, double height, int sides, SheetCutter& cutter);
[[nodiscard]] Mesh sphere_mesh(double radius, SheetCutter& cutter);
/// In the plane y = 0: width along x, height along z.
[[nodiscard]] Mesh rectangle_mesh(double width, double height, SheetCutter& cutter);
/// A rhombus with its tips on x, folded along them.
[[nodiscard]] Mesh leaf_mesh(double length, double width, double fold, SheetCutter& cutter);

/// Adds the parallelogram corner + [0, 1] x_edge + [0, 1] y_edge with a cut of its own.
void add_face(Mesh& mesh, const Eigen::Vector3d& corner, const Eigen::Vector3d& x_edge,
              const Eigen::Vector3d& y_edge, SheetCutter& cutter);

/// Adds `part`, moved.
void add_moved(Mesh& mesh, const Mesh& part, const Eigen::Isometry3d& mesh_from_part);

}  // namespace saccade
