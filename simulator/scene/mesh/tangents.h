#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "simulator/scene/mesh/mesh.h"

namespace saccade {

/// The tangents and bitangents of one triangle: where u and v grow, v upwards.
struct TriangleTangents {
  Eigen::Vector3d tangent, bitangent;  ///< unit vectors
};

/// nullopt: its texture coordinates have no area.
[[nodiscard]] std::optional<TriangleTangents> tangents_of(
    const std::array<Eigen::Vector3d, 3>& corners, const std::array<Eigen::Vector2d, 3>& uvs);

/// Tangents at the vertices of a mesh for its normal maps. Those that its file states count; where
/// it states none, the mean of the tangents of the triangles around a vertex, each weighted by its
/// angle there, as MikkTSpace has it (Mikkelsen, 2008). Triangles whose texture is mirrored have a
/// mean of their own.
class VertexTangents {
 public:
  /// `vertices` are those of the mesh as they stand in the body, `body_from_mesh` of its vectors. The
  /// mesh has normal_uvs and outlives this.
  VertexTangents(const Mesh& mesh, const std::vector<Eigen::Vector3d>& vertices,
                 const Eigen::Matrix3d& body_from_mesh);

  /// Of the corners of a triangle, with the handedness of a normal of the mesh that is `normal`.
  struct Corners {
    std::array<Eigen::Vector3d, 3> tangents;  ///< zero where there is none
    double handedness;
  };
  [[nodiscard]] Corners of(const Triangle& triangle, const Eigen::Vector3d& normal) const;

 private:
  void add(const Triangle& triangle);
  [[nodiscard]] std::optional<TriangleTangents> own_tangents(const Triangle& triangle) const;
  [[nodiscard]] bool is_stated(std::uint32_t vertex) const {
    return !mesh_.tangents.empty() && mesh_.tangents[vertex].head<3>().squaredNorm() > 0;
  }

  const Mesh& mesh_;
  const std::vector<Eigen::Vector3d>& vertices_;
  Eigen::Matrix3d body_from_mesh_;
  bool mirrors_;
  std::array<std::vector<Eigen::Vector3d>, 2> means_;  ///< of triangles as they are, and mirrored
};

}  // namespace saccade
