#include "simulator/scene/mesh/tangents.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace saccade {
namespace {

/// Whether (u, v) run around a triangle against its corners.
bool is_mirrored(const TriangleTangents& own, const Eigen::Vector3d& plane_normal) {
  return own.tangent.cross(own.bitangent).dot(plane_normal) < 0;
}

}  // namespace

std::optional<TriangleTangents> tangents_of(const std::array<Eigen::Vector3d, 3>& corners,
                                            const std::array<Eigen::Vector2d, 3>& uvs) {
  constexpr double kLeastArea = 1e-12;
  const Eigen::Vector3d to_b = corners[1] - corners[0];
  const Eigen::Vector3d to_c = corners[2] - corners[0];
  const Eigen::Vector2d b = uvs[1] - uvs[0];
  const Eigen::Vector2d c = uvs[2] - uvs[0];
  const double area = b.x() * c.y() - c.x() * b.y();
  if (!(std::abs(area) > kLeastArea * std::max(b.squaredNorm(), c.squaredNorm())))
    return std::nullopt;
  const double sign = area > 0 ? 1 : -1;
  const Eigen::Vector3d tangent = sign * (c.y() * to_b - b.y() * to_c);
  const Eigen::Vector3d bitangent = sign * (b.x() * to_c - c.x() * to_b);
  if (!(tangent.norm() > 0 && bitangent.norm() > 0)) return std::nullopt;
  return TriangleTangents{tangent.normalized(), bitangent.normalized()};
}

VertexTangents::VertexTangents(const Mesh& mesh, const std::vector<Eigen::Vector3d>& vertices,
                               const Eigen::Matrix3d& body_from_mesh)
    : mesh_(mesh),
      vertices_(vertices),
      body_from_mesh_(body_from_mesh),
      mirrors_(body_from_mesh.determinant() < 0) {
  SACCADE_CHECK(mesh.normal_uvs.size() == mesh.vertices.size());
  SACCADE_CHECK(mesh.tangents.empty() || mesh.tangents.size() == mesh.vertices.size());
  for (auto& means : means_) means.assign(vertices.size(), Eigen::Vector3d::Zero());
  for (const Triangle& triangle : mesh.triangles)
    if (mesh.materials[triangle.material].normal_map) add(triangle);
}

std::optional<TriangleTangents> VertexTangents::own_tangents(const Triangle& triangle) const {
  std::array<Eigen::Vector3d, 3> corners;
  std::array<Eigen::Vector2d, 3> uvs;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    corners[i] = vertices_[triangle.corners[i]];
    uvs[i] = mesh_.normal_uvs[triangle.corners[i]];
  }
  return tangents_of(corners, uvs);
}

void VertexTangents::add(const Triangle& triangle) {
  const auto own = own_tangents(triangle);
  if (!own) return;
  const auto corner = [&](std::size_t i) -> const Eigen::Vector3d& {
    return vertices_[triangle.corners[i % 3]];
  };
  const Eigen::Vector3d plane_normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
  auto& means = means_[is_mirrored(*own, plane_normal) ? 1 : 0];
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d after = corner(i + 1) - corner(i);
    const Eigen::Vector3d before = corner(i + 2) - corner(i);
    const double angle = std::atan2(after.cross(before).norm(), after.dot(before));
    means[triangle.corners[i]] += angle * own->tangent;
  }
}

auto VertexTangents::of(const Triangle& triangle, const Eigen::Vector3d& normal) const -> Corners {
  Corners result{};
  result.tangents.fill(Eigen::Vector3d::Zero());
  const auto corner = [&](std::size_t i) -> const Eigen::Vector3d& {
    return vertices_[triangle.corners[i]];
  };
  const Eigen::Vector3d plane_normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
  const auto own = own_tangents(triangle);
  const bool mirrored = own && is_mirrored(*own, plane_normal);
  result.handedness = own && own->tangent.cross(own->bitangent).dot(normal) < 0 ? -1 : 1;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t vertex = triangle.corners[i];
    if (is_stated(vertex)) {
      result.tangents[i] = body_from_mesh_ * mesh_.tangents[vertex].head<3>();
      if (i == 0) result.handedness = (mesh_.tangents[vertex].w() < 0) != mirrors_ ? -1 : 1;
    } else {
      result.tangents[i] = means_[mirrored ? 1 : 0][vertex];
    }
    if (result.tangents[i].norm() > 0) result.tangents[i].normalize();
  }
  return result;
}

}  // namespace saccade
