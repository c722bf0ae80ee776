#include "simulator/scene/world/world_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/check.h"
#include "simulator/scene/world/world_shapes.h"

namespace saccade {
namespace {

constexpr std::array kGeometries{
    WorldGeometryKind{WorldGeometry::kRoom, "room",
                      "a room with cupboards, tables, shelves and frames made of boxes",
                      build_room},
    WorldGeometryKind{WorldGeometry::kCorridor, "corridor",
                      "a narrow corridor with doors, pilasters and beams", build_corridor},
    WorldGeometryKind{WorldGeometry::kLayers, "layers",
                      "rectangles at many depths before a wall: many occlusions", build_layers},
    WorldGeometryKind{WorldGeometry::kClutter, "clutter",
                      "a hundred boxes, cylinders, spheres and cones, floating and standing",
                      build_clutter},
    WorldGeometryKind{WorldGeometry::kFurniture, "furniture",
                      "furniture of the Debian package sweethome3d-furniture", build_furniture},
    WorldGeometryKind{WorldGeometry::kRelief, "relief", "a smooth relief that leans towards a wall",
                      build_relief},
    WorldGeometryKind{WorldGeometry::kThin, "thin", "thin rods, twigs with leaves and grilles",
                      build_thin},
    WorldGeometryKind{WorldGeometry::kMoving, "moving",
                      "one of the others, and one object that moves on its own", build_moving},
};

}  // namespace

std::span<const WorldGeometryKind> world_geometries() { return kGeometries; }

const WorldGeometryKind& find_world_geometry(WorldGeometry geometry) {
  const auto found = std::ranges::find(kGeometries, geometry, &WorldGeometryKind::geometry);
  SACCADE_CHECK(found != kGeometries.end());
  return *found;
}

WorldShell draw_wide_shell(WorldDice& dice) {
  WorldShell shell;
  shell.front = dice.between(4.0, 7.0);
  shell.back = dice.between(2.0, 3.0);
  shell.left = dice.between(3.5, 6.0);
  shell.right = dice.between(3.5, 6.0);
  shell.down = dice.between(1.3, 2.2);
  shell.up = dice.between(1.6, 3.0);
  shell.turn = dice.between(-0.35, 0.35);
  return shell;
}

Eigen::Vector3d draw_place_in_view(WorldDice& dice, double near_m, double far_m) {
  constexpr double kDegree = 3.14159265358979 / 180;
  const double y = dice.log_between(near_m, far_m);
  return {y * std::tan(dice.between(-60, 60) * kDegree), y,
          y * std::tan(dice.between(-40, 40) * kDegree)};
}

Mesh draw_solid(WorldDice& dice, double radius, SheetCutter& cutter) {
  constexpr int kSides = 32;
  const int kind = dice.integer(0, 3);
  if (kind == 0) return sphere_mesh(radius, cutter);
  // What is left of the ball's diameter by another side of this part of it.
  const double part = dice.between(0.35, 0.85);
  const double rest = std::sqrt(1 - part * part);
  if (kind == 1) return cylinder_mesh(radius * part, 2 * radius * rest, kSides, cutter);
  if (kind == 2) {
    // The base circle at z = -height / 2 is the farthest from the middle.
    const double height = 2 * radius * rest;
    return cone_mesh(radius * part, height, kSides, cutter);
  }
  const double other = dice.between(0.35, 0.85);
  const Eigen::Vector3d size =
      2 * radius * Eigen::Vector3d(part, rest * other, rest * std::sqrt(1 - other * other));
  return box_mesh(size, cutter);
}

}  // namespace saccade
