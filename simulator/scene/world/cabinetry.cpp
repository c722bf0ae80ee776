#include "simulator/scene/world/cabinetry.h"

#include <utility>

#include "simulator/scene/world/world_layout.h"
#include "simulator/scene/world/world_shapes.h"

namespace saccade {
namespace {

using Eigen::Vector3d;

/// Parts go into one another by this much, so that no two faces lie in one plane.
constexpr double kJoint_m = 0.004;

Cabinet cupboard(WorldDice& dice, SheetCutter& cutter) {
  const Vector3d size = dice.vector({0.5, 0.3, 0.5}, {1.3, 0.6, 2.0});
  Cabinet made{"cupboard", {}, size};
  add_block(made.mesh, {-0.5 * size.x(), -0.5 * size.y(), -kFootDepth_m},
            size + Vector3d(0, 0, kFootDepth_m), cutter);
  // Doors in front of it.
  const int doors = dice.integer(1, 3);
  const double width = size.x() / doors;
  for (int i = 0; i < doors; ++i)
    add_block(made.mesh, {-0.5 * size.x() + width * (i + 0.04), -0.5 * size.y() - 0.015, 0.03},
              {0.92 * width, 0.015 + kJoint_m, size.z() - 0.06}, cutter);
  return made;
}

/// Legs at the corners of a rectangle.
void add_legs(Mesh& mesh, double x, double y, double thickness, double height,
              SheetCutter& cutter) {
  for (const double side : {-1.0, 1.0})
    for (const double end : {-1.0, 1.0})
      add_block(mesh, {side * x - 0.5 * thickness, end * y - 0.5 * thickness, -kFootDepth_m},
                {thickness, thickness, height + kFootDepth_m}, cutter);
}

Cabinet table(WorldDice& dice, SheetCutter& cutter) {
  const Vector3d size = dice.vector({0.7, 0.5, 0.45}, {1.6, 0.9, 1.0});
  constexpr double kTop_m = 0.04;
  Cabinet made{"table", {}, size};
  add_block(made.mesh, {-0.5 * size.x(), -0.5 * size.y(), size.z() - kTop_m},
            {size.x(), size.y(), kTop_m}, cutter);
  add_legs(made.mesh, 0.45 * size.x(), 0.42 * size.y(), 0.06, size.z() - kTop_m + kJoint_m, cutter);
  // Things on it.
  double left = -0.42 * size.x();
  double highest = 0;
  while (true) {
    const Vector3d thing = dice.vector({0.08, 0.08, 0.05}, {0.35, 0.35, 0.45});
    if (left + thing.x() > 0.42 * size.x()) break;
    add_block(made.mesh, {left, dice.between(-0.4, 0) * size.y(), size.z() - kJoint_m},
              {thing.x(), std::min(thing.y(), 0.4 * size.y()), thing.z()}, cutter);
    left += thing.x() + dice.between(0.03, 0.3);
    highest = std::max(highest, thing.z());
  }
  made.size.z() += highest;
  return made;
}

Cabinet shelf(WorldDice& dice, SheetCutter& cutter) {
  const Vector3d size = dice.vector({0.7, 0.25, 1.2}, {1.4, 0.4, 2.1});
  constexpr double kBoard_m = 0.025;
  Cabinet made{"shelf", {}, size};
  for (const double side : {-0.5, 0.5})
    add_block(made.mesh, {side * size.x() - 0.5 * kBoard_m, -0.5 * size.y(), -kFootDepth_m},
              {kBoard_m, size.y(), size.z() + kFootDepth_m}, cutter);
  add_block(made.mesh, {-0.5 * size.x(), 0.5 * size.y() - kBoard_m, 0},
            {size.x(), 0.9 * kBoard_m, size.z() - kJoint_m}, cutter);
  const int boards = dice.integer(4, 6);
  const double gap = (size.z() - kBoard_m) / (boards - 1);
  for (int i = 0; i < boards; ++i) {
    const double z = i * gap;
    add_block(made.mesh, {-0.49 * size.x(), -0.48 * size.y(), z},
              {0.98 * size.x(), 0.95 * size.y(), kBoard_m}, cutter);
    if (i + 1 == boards) break;
    // Books.
    for (double x = -0.47 * size.x(); x < 0.42 * size.x();) {
      const double width = dice.between(0.02, 0.09);
      const double front = dice.between(-0.45, -0.2) * size.y();
      const double height = dice.between(0.5, 0.9) * (gap - kBoard_m);
      if (dice.chance(0.85))
        add_block(made.mesh, {x, front, z + kBoard_m - kJoint_m}, {width, 0.5 * size.y(), height},
                  cutter);
      x += width + dice.between(0.002, 0.02);
    }
  }
  return made;
}

Cabinet chair(WorldDice& dice, SheetCutter& cutter) {
  const double seat = dice.between(0.42, 0.5), width = dice.between(0.4, 0.5);
  const double height = seat + dice.between(0.4, 0.6);
  Cabinet made{"chair", {}, {width, width, height}};
  add_block(made.mesh, {-0.5 * width, -0.5 * width, seat - 0.03}, {width, width, 0.03}, cutter);
  add_legs(made.mesh, 0.43 * width, 0.43 * width, 0.04, seat - 0.03 + kJoint_m, cutter);
  add_block(made.mesh, {-0.48 * width, 0.42 * width, seat - kJoint_m},
            {0.96 * width, 0.03, height - seat}, cutter);
  return made;
}

}  // namespace

void add_block(Mesh& mesh, const Vector3d& low, const Vector3d& size, SheetCutter& cutter) {
  add_moved(mesh, box_mesh(size, cutter), placed_at(low + 0.5 * size, Eigen::Matrix3d::Identity()));
}

Cabinet draw_cabinet(WorldDice& dice, SheetCutter& cutter) {
  const int kind = dice.integer(0, 5);
  if (kind <= 1) return cupboard(dice, cutter);
  if (kind == 2) return shelf(dice, cutter);
  if (kind == 3) return chair(dice, cutter);
  return table(dice, cutter);
}

}  // namespace saccade
