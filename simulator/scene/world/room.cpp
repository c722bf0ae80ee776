#include <utility>

#include "simulator/scene/world/cabinetry.h"
#include "simulator/scene/world/world_geometry.h"
#include "simulator/scene/world/world_shapes.h"

namespace saccade {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::uint64_t kRoomStream = 2500;

WorldShell draw_room(WorldDice& dice) {
  WorldShell shell;
  shell.front = dice.between(2.8, 5.0);
  shell.back = dice.between(1.3, 2.5);
  shell.left = dice.between(1.9, 3.2);
  shell.right = dice.between(1.9, 3.2);
  shell.down = dice.between(1.0, 1.5);
  shell.up = dice.between(1.1, 1.6);
  shell.turn = dice.between(-0.6, 0.6);
  return shell;
}

/// Where the back of a thing of that depth is at a wall: x and y of its middle in the shell, turned
/// by quarter turns.
Isometry3d at_wall(const WorldShell& shell, int wall, double along, double half_depth) {
  constexpr double kGap_m = 0.012;
  const double away = half_depth + kGap_m;
  Matrix3d turn = Matrix3d::Identity();
  if (wall == 0)  // front
    return placed_at({-shell.left + along * (shell.left + shell.right), shell.front - away, 0},
                     turn);
  const double y = -shell.back + along * (shell.front + shell.back);
  if (wall == 1) {  // left: its back towards -x
    turn << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    return placed_at({-shell.left + away, y, 0}, turn);
  }
  turn << 0, 1, 0, -1, 0, 0, 0, 0, 1;
  return placed_at({shell.right - away, y, 0}, turn);
}

void add_cabinets(WorldLayout& layout, WorldDice& dice) {
  constexpr int kCabinets = 16, kAttempts = 120;
  const WorldShell& shell = layout.shell();
  for (int attempt = 0, placed = 0; attempt < kAttempts && placed < kCabinets; ++attempt) {
    Cabinet cabinet = draw_cabinet(dice, layout.cutter());
    const double along = dice.between(0.05, 0.95);
    const int wall = dice.integer(0, 4);
    Isometry3d pose = at_wall(shell, std::min(wall, 2), along, 0.5 * cabinet.size.y());
    if (wall > 2) {  // anywhere
      const Vector3d at = dice.vector({-shell.left, 0.5, 0}, {shell.right, shell.front, 0});
      pose = placed_at(at, turn_by_slope(dice.between(-3, 3)));
    }
    pose = layout.world_from_shell() * pose;
    pose.translation().z() = -shell.down;
    const Eigen::AlignedBox3d box(
        Vector3d(-0.5 * cabinet.size.x(), -0.5 * cabinet.size.y() - 0.02, 0),
        Vector3d(0.5 * cabinet.size.x(), 0.5 * cabinet.size.y(), cabinet.size.z()));
    const double footprint = 0.5 * cabinet.size.head<2>().norm();
    const Vector3d middle = pose * Vector3d(0, 0, 0);
    if (cabinet.size.z() > shell.down + shell.up || !layout.is_clear(box, pose) ||
        !layout.take(middle, footprint))
      continue;
    layout.add(cabinet.name, std::move(cabinet.mesh), pose);
    ++placed;
  }
}

/// Frames on the walls, above what stands before them.
void add_frames(WorldLayout& layout, WorldDice& dice) {
  constexpr int kFrames = 9;
  const WorldShell& shell = layout.shell();
  for (int i = 0; i < kFrames; ++i) {
    const Vector3d size = dice.vector({0.25, 0.02, 0.25}, {0.8, 0.05, 0.7});
    const double along = dice.between(0.1, 0.9);
    Isometry3d pose = at_wall(shell, dice.integer(0, 2), along, 0.5 * size.y() - 0.02);
    pose = layout.world_from_shell() * pose;
    pose.translation().z() = dice.between(0.1, shell.up - 0.45);
    if (!layout.is_clear(Eigen::AlignedBox3d(-0.5 * size, 0.5 * size), pose) ||
        !layout.take(pose.translation(), 0.5 * size.norm()))
      continue;
    layout.add("frame", box_mesh(size, layout.cutter()), pose);
  }
}

}  // namespace

void build_room(WorldLayout& layout) {
  WorldDice dice = layout.dice(kRoomStream);
  layout.close(draw_room(dice));
  add_cabinets(layout, dice);
  add_frames(layout, dice);
}

}  // namespace saccade
