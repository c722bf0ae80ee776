#include "simulator/scene/mesh/tangents.h"

#include <gtest/gtest.h>

#include "simulator/scene/texture/normal_texture.h"

namespace saccade {
namespace {

/// Two triangles over the square [0, 1]^2 at z = 0, with texture coordinates that `uv_of` gives.
template <class UvOf>
Mesh square(const UvOf& uv_of) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    mesh.normal_uvs.push_back(uv_of(Eigen::Vector2d(vertex.head<2>())));
  mesh.triangles = {{{0, 1, 2}, 0}, {{0, 2, 3}, 0}};
  mesh.materials.resize(1);
  mesh.materials[0].normal_map = std::make_shared<const NormalTexture>(
      std::array<ImageF, 3>{ImageF(2, 2), ImageF(2, 2), ImageF(2, 2, 1)}, WrapModes{});
  return mesh;
}

TEST(Tangents, FollowTheTextureCoordinates) {
  const Mesh mesh = square([](const Eigen::Vector2d& p) { return Eigen::Vector2d(p.y(), -p.x()); });
  const VertexTangents tangents(mesh, mesh.vertices, Eigen::Matrix3d::Identity());
  for (const Triangle& triangle : mesh.triangles) {
    const auto corners = tangents.of(triangle, {0, 0, 1});
    for (const Eigen::Vector3d& tangent : corners.tangents)
      EXPECT_LT((tangent - Eigen::Vector3d(0, 1, 0)).norm(), 1e-12);
    EXPECT_EQ(corners.handedness, 1);
    EXPECT_EQ(tangents.of(triangle, {0, 0, -1}).handedness, -1);
  }
}

TEST(Tangents, AreMirroredWithThem) {
  const Mesh mesh = square([](const Eigen::Vector2d& p) { return Eigen::Vector2d(-p.x(), p.y()); });
  const VertexTangents tangents(mesh, mesh.vertices, Eigen::Matrix3d::Identity());
  const auto corners = tangents.of(mesh.triangles[0], {0, 0, 1});
  EXPECT_LT((corners.tangents[0] - Eigen::Vector3d(-1, 0, 0)).norm(), 1e-12);
  EXPECT_EQ(corners.handedness, -1);
}

TEST(Tangents, ThatAreStatedCount) {
  Mesh mesh = square([](const Eigen::Vector2d& p) { return p; });
  mesh.tangents.assign(4, {0, 0.6, 0.8, -1});
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const VertexTangents tangents(mesh, mesh.vertices, turn);
  const auto corners = tangents.of(mesh.triangles[0], {0, 0, 1});
  EXPECT_LT((corners.tangents[1] - turn * Eigen::Vector3d(0, 0.6, 0.8)).norm(), 1e-12);
  EXPECT_EQ(corners.handedness, -1);
  const Eigen::Matrix3d mirror = Eigen::Vector3d(-1, 1, 1).asDiagonal();
  EXPECT_EQ(VertexTangents(mesh, mesh.vertices, mirror).of(mesh.triangles[0], {0, 0, 1}).handedness,
            1);
}

TEST(Tangents, AreNoneWithoutAnAreaOfTheTexture) {
  EXPECT_FALSE(
      tangents_of({Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0)},
                  {Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 1), Eigen::Vector2d(2, 2)}));
  const Mesh mesh = square([](const Eigen::Vector2d&) { return Eigen::Vector2d(0.5, 0.5); });
  const VertexTangents tangents(mesh, mesh.vertices, Eigen::Matrix3d::Identity());
  for (const Eigen::Vector3d& tangent : tangents.of(mesh.triangles[0], {0, 0, 1}).tangents)
    EXPECT_TRUE(tangent.isZero());
}

}  // namespace
}  // namespace saccade
