#include "simulator/scene/world/world_shapes.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace saccade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kFullTurn = 2 * std::numbers::pi;

std::uint32_t add_vertex(Mesh& mesh, const Vector3d& at, const Vector3d& normal,
                         const Vector2d& uv) {
  mesh.vertices.push_back(at);
  mesh.normals.push_back(normal);
  mesh.uvs.push_back(uv);
  return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

Vector3d on_circle(double radius, double turns, double z) {
  return {radius * std::cos(kFullTurn * turns), radius * std::sin(kFullTurn * turns), z};
}

/// A disc across z whose visible side is `up`.
void add_disc(Mesh& mesh, double radius, double z, double up, int sides, SheetCutter& cutter) {
  const SheetCut cut = cutter.cut(2 * radius, 2 * radius);
  const Vector3d normal(0, 0, up);
  const std::uint32_t centre = add_vertex(mesh, {0, 0, z}, normal, cut.uv(radius, radius));
  for (int i = 0; i < sides; ++i) {
    const Vector3d at = on_circle(radius, static_cast<double>(i) / sides, z);
    add_vertex(mesh, at, normal, cut.uv(radius + at.x(), radius + at.y()));
  }
  const auto count = static_cast<std::uint32_t>(sides);
  for (std::uint32_t i = 0; i < count; ++i)
    mesh.triangles.push_back(
        {{centre, centre + 1 + i, centre + 1 + (i + 1) % count}, cut.material});
}

/// One of the six faces of a cube that is blown up to a sphere: (a, b) in [-1, 1]^2 on the face
/// `out` away from the centre.
void add_sphere_face(Mesh& mesh, double radius, const Vector3d& out, const Vector3d& x,
                     const Vector3d& y, SheetCutter& cutter) {
  constexpr std::uint32_t kCells = 8;
  // A quarter of the circumference over the face: true to scale in the middle, half along the rim.
  const double side = 0.25 * kFullTurn * radius;
  const SheetCut cut = cutter.cut(side, side);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (std::uint32_t j = 0; j <= kCells; ++j)
    for (std::uint32_t i = 0; i <= kCells; ++i) {
      const double u = static_cast<double>(i) / kCells, v = static_cast<double>(j) / kCells;
      // Equal angles, so that cells are about equally large.
      const double a = std::tan(0.125 * kFullTurn * (2 * u - 1));
      const double b = std::tan(0.125 * kFullTurn * (2 * v - 1));
      const Vector3d normal = (out + a * x + b * y).normalized();
      add_vertex(mesh, radius * normal, normal, cut.uv(u * side, v * side));
    }
  for (std::uint32_t j = 0; j < kCells; ++j)
    for (std::uint32_t i = 0; i < kCells; ++i) {
      const std::uint32_t corner = first + j * (kCells + 1) + i;
      const std::uint32_t above = corner + kCells + 1;
      mesh.triangles.push_back({{corner, corner + 1, above + 1}, cut.material});
      mesh.triangles.push_back({{corner, above + 1, above}, cut.material});
    }
}

}  // namespace

void add_face(Mesh& mesh, const Vector3d& corner, const Vector3d& x_edge, const Vector3d& y_edge,
              SheetCutter& cutter) {
  const double width = x_edge.norm(), height = y_edge.norm();
  const SheetCut cut = cutter.cut(width, height);
  const Vector3d normal = x_edge.cross(y_edge).normalized();
  const std::uint32_t a = add_vertex(mesh, corner, normal, cut.uv(0, 0));
  const std::uint32_t b = add_vertex(mesh, corner + x_edge, normal, cut.uv(width, 0));
  const std::uint32_t c = add_vertex(mesh, corner + x_edge + y_edge, normal, cut.uv(width, height));
  const std::uint32_t d = add_vertex(mesh, corner + y_edge, normal, cut.uv(0, height));
  mesh.triangles.push_back({{a, b, c}, cut.material});
  mesh.triangles.push_back({{a, c, d}, cut.material});
}

Mesh box_mesh(const Vector3d& size, SheetCutter& cutter) {
  Mesh mesh;
  const Vector3d x(size.x(), 0, 0), y(0, size.y(), 0), z(0, 0, size.z());
  const Vector3d low = -0.5 * size;
  add_face(mesh, low, x, z, cutter);
  add_face(mesh, low + y + x, -x, z, cutter);
  add_face(mesh, low + y, -y, z, cutter);
  add_face(mesh, low + x, y, z, cutter);
  add_face(mesh, low + z, x, y, cutter);
  add_face(mesh, low + y, x, -y, cutter);
  return mesh;
}

Mesh cylinder_mesh(double radius, double height, int sides, SheetCutter& cutter) {
  Mesh mesh;
  const double around = kFullTurn * radius;
  const SheetCut cut = cutter.cut(around, height);
  for (int i = 0; i <= sides; ++i) {
    const double turns = static_cast<double>(i) / sides;
    const Vector3d normal = on_circle(1, i == sides ? 0 : turns, 0);
    const Vector3d half(0, 0, 0.5 * height);
    add_vertex(mesh, radius * normal - half, normal, cut.uv(around * turns, 0));
    add_vertex(mesh, radius * normal + half, normal, cut.uv(around * turns, height));
  }
  for (std::uint32_t i = 0; i < 2 * static_cast<std::uint32_t>(sides); i += 2) {
    mesh.triangles.push_back({{i, i + 2, i + 3}, cut.material});
    mesh.triangles.push_back({{i, i + 3, i + 1}, cut.material});
  }
  add_disc(mesh, radius, -0.5 * height, -1, sides, cutter);
  add_disc(mesh, radius, 0.5 * height, 1, sides, cutter);
  return mesh;
}

Mesh cone_mesh(double radius, double height, int sides, SheetCutter& cutter) {
  Mesh mesh;
  // The mantle is a sector of a disc, which is laid flat onto the texture.
  const double slant = std::hypot(radius, height);
  const double sector = radius / slant;  // [turns]
  const SheetCut cut = cutter.cut(2 * slant, 2 * slant);
  for (int i = 0; i < sides; ++i) {
    const auto corner = [&](double turns) {
      const Vector3d flat = on_circle(slant, sector * turns, 0);
      const double at = turns >= 1 ? 0 : turns;
      const Vector3d normal = on_circle(height, at, radius).normalized();
      return add_vertex(mesh, on_circle(radius, at, -0.5 * height), normal,
                        cut.uv(slant + flat.x(), slant + flat.y()));
    };
    const double from = static_cast<double>(i) / sides, to = static_cast<double>(i + 1) / sides;
    const std::uint32_t a = corner(from), b = corner(to);
    const std::uint32_t tip =
        add_vertex(mesh, {0, 0, 0.5 * height},
                   on_circle(height, 0.5 * (from + to), radius).normalized(), cut.uv(slant, slant));
    mesh.triangles.push_back({{a, b, tip}, cut.material});
  }
  add_disc(mesh, radius, -0.5 * height, -1, sides, cutter);
  return mesh;
}

Mesh sphere_mesh(double radius, SheetCutter& cutter) {
  Mesh mesh;
  const std::array<Vector3d, 3> axes{Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3d &out = axes[k], &x = axes[(k + 1) % 3], &y = axes[(k + 2) % 3];
    add_sphere_face(mesh, radius, out, x, y, cutter);
    add_sphere_face(mesh, radius, -out, y, x, cutter);
  }
  return mesh;
}

Mesh rectangle_mesh(double width, double height, SheetCutter& cutter) {
  Mesh mesh;
  add_face(mesh, {-0.5 * width, 0, -0.5 * height}, {width, 0, 0}, {0, 0, height}, cutter);
  return mesh;
}

Mesh leaf_mesh(double length, double width, double fold, SheetCutter& cutter) {
  Mesh mesh;
  const SheetCut cut = cutter.cut(length, width);
  for (const double side : {-1.0, 1.0}) {
    const Vector3d rim(0, 0.5 * side * width, fold);
    const Vector3d normal = Vector3d::UnitX().cross(side * rim).normalized();
    const double y = 0.5 * (1 + side) * width;
    const std::uint32_t base =
        add_vertex(mesh, {-0.5 * length, 0, 0}, normal, cut.uv(0, 0.5 * width));
    add_vertex(mesh, {0.5 * length, 0, 0}, normal, cut.uv(length, 0.5 * width));
    add_vertex(mesh, rim, normal, cut.uv(0.5 * length, y));
    mesh.triangles.push_back({{base, base + 1, base + 2}, cut.material});
  }
  return mesh;
}

void add_moved(Mesh& mesh, const Mesh& part, const Eigen::Isometry3d& mesh_from_part) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vector3d& vertex : part.vertices) mesh.vertices.push_back(mesh_from_part * vertex);
  for (const Vector3d& normal : part.normals)
    mesh.normals.push_back(mesh_from_part.linear() * normal);
  mesh.uvs.insert(mesh.uvs.end(), part.uvs.begin(), part.uvs.end());
  for (Triangle triangle : part.triangles) {
    for (std::uint32_t& corner : triangle.corners) corner += first;
    mesh.triangles.push_back(triangle);
  }
}

}  // namespace saccade
