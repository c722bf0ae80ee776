#include "tests/support/meshes.h"

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "core/random.h"
#include "tests/support/planar_world.h"

namespace saccade::testing {
namespace {

using Point = Eigen::Vector3d;

void paint(Mesh& mesh, ImageF texture) {
  Material material;
  material.texture = std::make_shared<const Texture>(std::move(texture));
  mesh.materials = {material};
}

/// A closed surface over `columns` x `rows` cells of its texture: point(u, v), u and v in [0, 1].
template <class Surface>
Mesh grid(std::uint32_t columns, std::uint32_t rows, ImageF texture, const Surface& point) {
  Mesh mesh;
  for (std::uint32_t j = 0; j <= rows; ++j)
    for (std::uint32_t i = 0; i <= columns; ++i) {
      const double u = static_cast<double>(i) / columns;
      const double v = static_cast<double>(j) / rows;
      mesh.vertices.push_back(point(u, v));
      mesh.uvs.emplace_back(u, v);
    }
  for (std::uint32_t j = 0; j < rows; ++j)
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t a = j * (columns + 1) + i;
      const std::uint32_t b = a + columns + 1;
      mesh.triangles.push_back({{a, a + 1, b}, 0});
      mesh.triangles.push_back({{b, a + 1, b + 1}, 0});
    }
  paint(mesh, std::move(texture));
  return mesh;
}

void append_rectangle(Mesh& mesh, const Point& corner, const Point& right, const Point& down) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Point& vertex :
       {corner, Point(corner + right), Point(corner + right + down), Point(corner + down)})
    mesh.vertices.push_back(vertex);
  for (const Eigen::Vector2d& uv : std::array<Eigen::Vector2d, 4>{{{0, 1}, {1, 1}, {1, 0}, {0, 0}}})
    mesh.uvs.push_back(uv);
  mesh.triangles.push_back({{first, first + 1, first + 2}, 0});
  mesh.triangles.push_back({{first, first + 2, first + 3}, 0});
}

}  // namespace

ImageF patches(int width, int height, std::uint64_t seed) {
  ImageF image = patch_texture(width, height, seed);
  for (float& value : image.pixels()) value = std::exp(value);
  return image;
}

Mesh rectangle(const Point& corner, const Point& right, const Point& down, ImageF texture) {
  Mesh mesh;
  append_rectangle(mesh, corner, right, down);
  paint(mesh, std::move(texture));
  return mesh;
}

Mesh slanted_wall() { return rectangle({-6, -5, 4}, {12, 0, 1}, {0, 10, 0}, patches(128, 128, 1)); }

Mesh ball(const Point& centre, double radius, std::uint32_t rings, ImageF texture) {
  return grid(2 * rings, rings, std::move(texture), [&](double u, double v) -> Point {
    const double latitude = std::numbers::pi * (v - 0.5);
    const double longitude = 2 * std::numbers::pi * u;
    return centre + radius * Point(std::cos(latitude) * std::cos(longitude), std::sin(latitude),
                                   std::cos(latitude) * std::sin(longitude));
  });
}

Mesh torus(const Point& centre, double radius, double tube_radius, std::uint32_t sides,
           ImageF texture) {
  return grid(sides, sides, std::move(texture), [&](double u, double v) -> Point {
    const double around = 2 * std::numbers::pi * u;
    const double tube = 2 * std::numbers::pi * v;
    const double from_axis = radius + tube_radius * std::cos(tube);
    return centre + Point(from_axis * std::cos(around), from_axis * std::sin(around),
                          tube_radius * std::sin(tube));
  });
}

Mesh box(const Point& size, ImageF texture) {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const Point normal = side * Point::Unit(axis);
      const Point right = Point::Unit((axis + 1) % 3);
      const Point down = normal.cross(right);
      append_rectangle(mesh, 0.5 * size.cwiseProduct(normal - right - down),
                       size.cwiseProduct(right), size.cwiseProduct(down));
    }
  paint(mesh, std::move(texture));
  return mesh;
}

Spline lively_motion(double duration_s, double speed_m_s, double rate_rad_s, std::uint64_t seed) {
  constexpr int kKnots = 6;
  const Random random(seed);
  const double step_s = duration_s / kKnots;
  const auto draw = [&](std::uint64_t k, int axis) {
    return 2 * random.uniform(k, static_cast<std::uint64_t>(axis)) - 1;
  };
  Point direction(draw(100, 0), draw(100, 1), 0.5 * draw(100, 2));
  Point axis(draw(101, 0), draw(101, 1), draw(101, 2));
  std::vector<StampedPose> poses(kKnots + 1);
  for (std::uint64_t k = 0; k < poses.size(); ++k) {
    const double t_s = step_s * static_cast<double>(k);
    const auto jitter = [&](int first) -> Point {
      return 0.3 * step_s * Point(draw(k, first), draw(k, first + 1), draw(k, first + 2));
    };
    poses[k].t_s = t_s;
    poses[k].world_from_camera = Rigid3(so3_exp(rate_rad_s * (t_s * axis.normalized() + jitter(0))),
                                        speed_m_s * (t_s * direction.normalized() + jitter(3)));
  }
  return Spline::interpolate(poses);
}

}  // namespace saccade::testing
