#include "simulator/scene/shading_table.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "simulator/scene/light/illumination.h"
#include "simulator/scene/scene_state.h"

namespace saccade {
namespace {

/// Positions [m] and texel coordinates beyond these are too coarse in single precision.
constexpr double kFarthestPosition_m = 1e3;
constexpr double kFarthestTexel = 1e5;

/// Where both other corners have no weight.
Eigen::Vector3d first_corner(const AffineForm& plane, const TriangleInterior& interior) {
  Eigen::Matrix3d forms;
  forms << plane.gradient.transpose(), interior.second.gradient.transpose(),
      interior.third.gradient.transpose();
  return forms.inverse() *
         -Eigen::Vector3d(plane.offset, interior.second.offset, interior.third.offset);
}

LaneVectors minus(const LaneVectors& a, const LaneVectors& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

LaneVectors point_on(const RayLanes& rays, const FloatLanes& distance) {
  return {rays.origin.x + distance * rays.direction.x, rays.origin.y + distance * rays.direction.y,
          rays.origin.z + distance * rays.direction.z};
}

}  // namespace

ShadingTable::ShadingTable(const std::vector<TriangleSurface>& surfaces,
                           const std::vector<TriangleInterior>& interiors,
                           const std::vector<ShadingNormals>& normals) {
  std::unordered_map<const Texture*, std::uint32_t> known;
  const auto gradient = [](const Eigen::Vector3d& v) {
    return Gradient{static_cast<float>(v.x()), static_cast<float>(v.y()),
                    static_cast<float>(v.z())};
  };
  rows_.reserve(surfaces.size());
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const TriangleSurface& surface = surfaces[i];
    const TriangleInterior& interior = interiors[i];
    const Eigen::Vector3d corner = first_corner(surface.plane, interior);
    const double column = surface.x.at(corner);
    const double row = surface.y.at(corner);
    Row own{};
    own.corner = gradient(corner);
    own.plane = gradient(surface.plane.gradient);
    own.column = gradient(surface.x.gradient);
    own.row = gradient(surface.y.gradient);
    own.column_at_corner = static_cast<float>(column);
    own.row_at_corner = static_cast<float>(row);
    own.texture = kUntextured;
    own.object = surface.object;
    own.factor = static_cast<float>(surface.factor);
    own.self_light = static_cast<float>(surface.self_light);
    if (surface.texture != nullptr) {
      const auto [found, is_new] =
          known.emplace(surface.texture, static_cast<std::uint32_t>(textures_.size()));
      if (is_new) textures_.push_back(surface.texture);
      own.texture = found->second;
    }
    if (!normals.empty()) {
      // n(p) = n_0 + second(p) (n_1 - n_0) + third(p) (n_2 - n_0), component by component.
      own.normal_at_corner = gradient(normals[i][0].cast<double>());
      for (int axis = 0; axis < 3; ++axis) {
        const auto from_first = [&](std::size_t k) {
          return static_cast<double>(normals[i][k][axis] - normals[i][0][axis]);
        };
        own.normal[static_cast<std::size_t>(axis)] = gradient(
            from_first(1) * interior.second.gradient + from_first(2) * interior.third.gradient);
      }
    }
    is_precise_ = is_precise_ && std::abs(column) < kFarthestTexel &&
                  std::abs(row) < kFarthestTexel &&
                  corner.cwiseAbs().maxCoeff() < kFarthestPosition_m;
    rows_.push_back(own);
  }
}

void ShadingTable::prefetch(const std::array<TriangleId, kRayPacket>& triangles,
                            std::size_t count) const {
  for (std::size_t i = 0; i < count; ++i) {
    if (triangles[i] == kNothing) continue;
    const char* row = reinterpret_cast<const char*>(&rows_[triangles[i]]);
    __builtin_prefetch(row);
    __builtin_prefetch(row + 64);
  }
}

template <class Select>
LaneVectors ShadingTable::gather(const std::array<TriangleId, kRayPacket>& triangles,
                                 std::size_t count, const Select& select) const {
  LaneVectors vectors;
  for (FloatLanes* lanes : {&vectors.x, &vectors.y, &vectors.z}) lanes->setZero();
  for (std::size_t i = 0; i < count; ++i) {
    if (triangles[i] == kNothing) continue;
    const Gradient& vector = select(rows_[triangles[i]]);
    const auto lane = static_cast<Eigen::Index>(i);
    vectors.x[lane] = vector.x;
    vectors.y[lane] = vector.y;
    vectors.z[lane] = vector.z;
  }
  return vectors;
}

void ShadingTable::sample(const RayLanes& rays, std::size_t count, bool filtered,
                          ViewLanes& view) const {
  const LaneVectors corner =
      gather(view.triangles, count, [](const Row& row) { return row.corner; });
  const LaneVectors normal =
      gather(view.triangles, count, [](const Row& row) { return row.plane; });
  const FloatLanes along = normal.dot(rays.direction);
  const FloatLanes distance = normal.dot(minus(corner, rays.origin)) / along;
  view.distance = (distance > 0 && distance < static_cast<float>(kFarthest)).select(distance, 0.0F);
  const LaneVectors from_corner = minus(point_on(rays, view.distance), corner);
  const LaneVectors column =
      gather(view.triangles, count, [](const Row& row) { return row.column; });
  const LaneVectors row = gather(view.triangles, count, [](const Row& r) { return r.row; });
  view.x = column.dot(from_corner);
  view.y = row.dot(from_corner);
  FloatLanes level = FloatLanes::Zero();
  if (filtered) {
    // The level of sample_surface(ray, triangle, differential).
    const auto squared_texels = [&](const LaneVectors& change) -> FloatLanes {
      const FloatLanes back = normal.dot(change) / along;
      const LaneVectors shift{view.distance * (change.x - back * rays.direction.x),
                              view.distance * (change.y - back * rays.direction.y),
                              view.distance * (change.z - back * rays.direction.z)};
      const FloatLanes across = column.dot(shift);
      const FloatLanes down = row.dot(shift);
      return across * across + down * down;
    };
    level = squared_texels(rays.right).max(squared_texels(rays.down));
  }
  view.objects.fill(kNothing);
  for (std::size_t i = 0; i < count; ++i) {
    if (view.triangles[i] == kNothing) continue;
    const auto lane = static_cast<Eigen::Index>(i);
    const Row& own = rows_[view.triangles[i]];
    view.objects[i] = own.object;
    if (!(view.distance[lane] > 0)) continue;
    view.x[lane] += own.column_at_corner;
    view.y[lane] += own.row_at_corner;
    if (own.texture == kUntextured) {
      view.radiance[lane] = view.x[lane];
      view.x[lane] = view.y[lane] = 0;
      continue;
    }
    const Texture& texture = *textures_[own.texture];
    const double x = static_cast<double>(view.x[lane]);
    const double y = static_cast<double>(view.y[lane]);
    if (level[lane] > 1) {
      const double of_pyramid = 0.5 * std::log2(static_cast<double>(level[lane]));
      view.radiance[lane] = own.factor * static_cast<float>(texture.at_texel(x, y, of_pyramid));
      const auto texel = static_cast<float>(1 / std::sqrt(static_cast<double>(level[lane])));
      view.x[lane] *= texel;
      view.y[lane] *= texel;
    } else {
      view.radiance[lane] = own.factor * static_cast<float>(texture.at_texel(x, y));
    }
  }
}

void ShadingTable::find_points(const RayLanes& rays, std::size_t count, const ViewLanes& view,
                               LitLanes& points) const {
  points.position = point_on(rays, view.distance);
  points.plane_normal = gather(view.triangles, count, [](const Row& row) { return row.plane; });
  const FloatLanes side =
      (points.plane_normal.dot(rays.direction) > 0).select(FloatLanes::Constant(-1), 1.0F);
  const LaneVectors from_corner = minus(
      points.position, gather(view.triangles, count, [](const Row& row) { return row.corner; }));
  points.shading_normal =
      gather(view.triangles, count, [](const Row& row) { return row.normal_at_corner; });
  const auto change = [&](std::size_t axis) -> FloatLanes {
    return gather(view.triangles, count, [axis](const Row& row) { return row.normal[axis]; })
        .dot(from_corner);
  };
  points.shading_normal.x += change(0);
  points.shading_normal.y += change(1);
  points.shading_normal.z += change(2);
  const FloatLanes scale = side / points.shading_normal.squared_norm().sqrt().max(1e-20F);
  for (FloatLanes LaneVectors::*axis : {&LaneVectors::x, &LaneVectors::y, &LaneVectors::z}) {
    points.plane_normal.*axis *= side;
    points.shading_normal.*axis *= scale;
  }
}

}  // namespace saccade
