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
/// As of sample_surface().
constexpr float kFarthest = 1e12F;

LaneVectors point_on(const RayLanes& rays, const FloatLanes& distance) {
  return {rays.origin.x + distance * rays.direction.x, rays.origin.y + distance * rays.direction.y,
          rays.origin.z + distance * rays.direction.z};
}

}  // namespace

ShadingTable::ShadingTable(const std::vector<TriangleSurface>& surfaces,
                           const std::vector<TriangleInterior>& interiors,
                           const std::vector<ShadingNormals>& normals) {
  std::unordered_map<const Texture*, std::uint32_t> known;
  const auto form = [](const AffineForm& f) {
    return Form{static_cast<float>(f.gradient.x()), static_cast<float>(f.gradient.y()),
                static_cast<float>(f.gradient.z()), static_cast<float>(f.offset)};
  };
  rows_.reserve(surfaces.size());
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const TriangleSurface& surface = surfaces[i];
    Row row{form(surface.plane), form(surface.x), form(surface.y),
            static_cast<float>(surface.factor), static_cast<float>(surface.self_light),
            kUntextured, surface.object, {}};
    if (surface.texture != nullptr) {
      const auto [found, is_new] =
          known.emplace(surface.texture, static_cast<std::uint32_t>(textures_.size()));
      if (is_new) textures_.push_back(surface.texture);
      row.texture = found->second;
      is_precise_ = is_precise_ && std::abs(surface.x.offset) < kFarthestTexel &&
                    std::abs(surface.y.offset) < kFarthestTexel;
    }
    is_precise_ = is_precise_ && std::abs(surface.plane.offset) < kFarthestPosition_m;
    if (!normals.empty()) {
      // n(p) = n_0 + second(p) (n_1 - n_0) + third(p) (n_2 - n_0)
      const TriangleInterior& interior = interiors[i];
      for (int axis = 0; axis < 3; ++axis) {
        const auto corner = [&](std::size_t k) {
          return static_cast<double>(normals[i][k][axis]);
        };
        const double to_second = corner(1) - corner(0);
        const double to_third = corner(2) - corner(0);
        row.normal[static_cast<std::size_t>(axis)] =
            form({to_second * interior.second.gradient + to_third * interior.third.gradient,
                  corner(0) + to_second * interior.second.offset +
                      to_third * interior.third.offset});
      }
    }
    rows_.push_back(row);
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

FloatLanes ShadingTable::at(const Forms& form, const LaneVectors& point) {
  return form[0] * point.x + form[1] * point.y + form[2] * point.z + form[3];
}

template <class Select>
auto ShadingTable::gather(const std::array<TriangleId, kRayPacket>& triangles, std::size_t count,
                          const Select& select) const -> Forms {
  Forms forms;
  for (FloatLanes& lanes : forms) lanes.setZero();
  for (std::size_t i = 0; i < count; ++i) {
    if (triangles[i] == kNothing) continue;
    const Form& form = select(rows_[triangles[i]]);
    const auto lane = static_cast<Eigen::Index>(i);
    forms[0][lane] = form.x;
    forms[1][lane] = form.y;
    forms[2][lane] = form.z;
    forms[3][lane] = form.offset;
  }
  return forms;
}

void ShadingTable::sample(const RayLanes& rays, std::size_t count, bool filtered,
                          ViewLanes& view) const {
  const Forms plane = gather(view.triangles, count, [](const Row& row) { return row.plane; });
  const LaneVectors normal{plane[0], plane[1], plane[2]};
  const FloatLanes along = normal.dot(rays.direction);
  const FloatLanes distance = -at(plane, rays.origin) / along;
  view.distance = (distance > 0 && distance < kFarthest).select(distance, 0.0F);
  const LaneVectors point = point_on(rays, view.distance);
  const Forms column = gather(view.triangles, count, [](const Row& row) { return row.column; });
  const Forms row = gather(view.triangles, count, [](const Row& r) { return r.row; });
  view.x = at(column, point);
  view.y = at(row, point);
  FloatLanes level = FloatLanes::Zero();
  if (filtered) {
    // The level of sample_surface(ray, triangle, differential).
    const auto squared_texels = [&](const LaneVectors& change) -> FloatLanes {
      const FloatLanes back = normal.dot(change) / along;
      const LaneVectors shift{view.distance * (change.x - back * rays.direction.x),
                              view.distance * (change.y - back * rays.direction.y),
                              view.distance * (change.z - back * rays.direction.z)};
      const FloatLanes across = LaneVectors{column[0], column[1], column[2]}.dot(shift);
      const FloatLanes down = LaneVectors{row[0], row[1], row[2]}.dot(shift);
      return across * across + down * down;
    };
    level = squared_texels(rays.right).max(squared_texels(rays.down));
  }
  view.radiance = view.x;
  view.objects.fill(kNothing);
  for (std::size_t i = 0; i < count; ++i) {
    if (view.triangles[i] == kNothing) continue;
    const auto lane = static_cast<Eigen::Index>(i);
    const Row& own = rows_[view.triangles[i]];
    view.objects[i] = own.object;
    if (!(view.distance[lane] > 0)) continue;
    if (own.texture == kUntextured) {
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
  const Forms plane = gather(view.triangles, count, [](const Row& row) { return row.plane; });
  points.plane_normal = {plane[0], plane[1], plane[2]};
  const FloatLanes side = (points.plane_normal.dot(rays.direction) > 0).select(FloatLanes::Constant(-1), 1.0F);
  std::array<FloatLanes, 3> normal;
  for (std::size_t axis = 0; axis < 3; ++axis)
    normal[axis] = at(gather(view.triangles, count,
                             [axis](const Row& row) { return row.normal[axis]; }),
                      points.position);
  points.shading_normal = {normal[0], normal[1], normal[2]};
  const FloatLanes scale = side / points.shading_normal.squared_norm().sqrt().max(1e-20F);
  for (FloatLanes LaneVectors::*axis : {&LaneVectors::x, &LaneVectors::y, &LaneVectors::z}) {
    points.plane_normal.*axis *= side;
    points.shading_normal.*axis *= scale;
  }
}

}  // namespace saccade
