#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "core/large_vector.h"
#include "simulator/scene/mesh/tangents.h"
#include "simulator/scene/scene_state.h"

namespace saccade {

/// Moves items behind others; where there are none and no room for them either, as they are.
template <class Items>
void append(Items& to, Items from) {
  if (to.empty() && to.capacity() < from.size()) {
    to = std::move(from);
  } else {
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
  }
}

/// Triangles in the form that rendering reads, in the frame of their body.
struct PreparedTriangles {
  std::vector<Corners> corners;
  std::vector<CornerIndices> corner_indices;  ///< of triangles whose corners move, else none
  LargeVector<TriangleSurface> surfaces;
  LargeVector<TriangleInterior> interiors;
  LargeVector<ShadingNormals> normals;
  std::vector<Cutout> cutouts;  ///< one per triangle, or none at all
  std::vector<NormalFrame>
      normal_frames;                     ///< of those that have a normal map, by their number here
  std::vector<GlossyTriangle> glossy;    ///< those that are, by their number here
  std::vector<std::uint16_t> instances;  ///< what each of them is labelled with

  void append(PreparedTriangles&& other);
  /// Makes room for `count` triangles in all, of what every triangle has but its corners.
  void reserve(std::size_t count);
};

/// Prepares the triangles of a mesh, one by one.
class TriangleSetup {
 public:
  TriangleSetup(const Mesh& mesh, const Eigen::Affine3d& body_from_mesh, std::uint32_t object);

  /// False, and nothing is added, for a triangle without area. `target` gets its cutout when the
  /// material has one, and no instance, which is the caller's to add.
  bool add(const Triangle& triangle, PreparedTriangles& target) const;
  /// The same for a triangle whose corners move, whatever its area is at first.
  void add_animated(const Triangle& triangle, PreparedTriangles& target) const;

 private:
  /// Notes what the last triangle of `target` mirrors.
  void add_gloss(const Triangle& triangle, PreparedTriangles& target) const;
  [[nodiscard]] TriangleSurface surface(const Triangle& triangle, const AffineForm& plane,
                                        const TriangleInterior& interior) const;
  [[nodiscard]] ShadingNormals shading_normals(const Triangle& triangle,
                                               const Eigen::Vector3d& plane_normal) const;

  /// `normals`: those of its corners.
  [[nodiscard]] NormalFrame normal_frame(const Triangle& triangle, const TriangleInterior& interior,
                                         const ShadingNormals& normals) const;
  /// 1, or -1 where the normal that the mesh states at a corner is against the triangle's winding.
  [[nodiscard]] double side_of(const Triangle& triangle, std::size_t corner,
                               const Eigen::Vector3d& plane_normal) const;

  const Mesh& mesh_;
  std::uint32_t object_;
  Eigen::Matrix3d normal_matrix_;
  std::vector<Eigen::Vector3d> vertices_;   ///< in the body's frame
  std::optional<VertexTangents> tangents_;  ///< where there are normal maps
};

}  // namespace saccade
