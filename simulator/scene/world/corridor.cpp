#include <utility>

#include "simulator/scene/world/cabinetry.h"
#include "simulator/scene/world/world_geometry.h"
#include "simulator/scene/world/world_shapes.h"

namespace saccade {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

constexpr std::uint64_t kCorridorStream = 2600;

WorldShell draw_corridor(WorldDice& dice) {
  WorldShell shell;
  shell.front = dice.between(5.0, 8.0);
  shell.back = dice.between(1.5, 2.5);
  shell.left = dice.between(1.05, 1.6);
  shell.right = dice.between(1.05, 1.6);
  shell.down = dice.between(1.0, 1.5);
  shell.up = dice.between(1.0, 1.5);
  shell.turn = dice.between(-0.12, 0.12);
  return shell;
}

/// A box in the axes of the corridor, unless it comes too near.
void add_if_clear(WorldLayout& layout, const char* name, const AlignedBox3d& box) {
  if (!layout.is_clear(box, layout.world_from_shell())) return;
  Mesh mesh;
  add_block(mesh, box.min(), box.sizes(), layout.cutter());
  layout.add(name, std::move(mesh), layout.world_from_shell());
}

/// Pilasters, doors and boxes along one wall; `side` is -1 for the left one.
void line_wall(WorldLayout& layout, WorldDice& dice, double side) {
  const WorldShell& shell = layout.shell();
  const double wall = side < 0 ? shell.left : shell.right;
  constexpr double kInWall_m = 0.05;
  const auto at_wall_box = [&](double y, double width, double depth, double low, double high) {
    const double inner = side * (wall - depth), outer = side * (wall + kInWall_m);
    return AlignedBox3d(Vector3d(std::min(inner, outer), y, low),
                        Vector3d(std::max(inner, outer), y + width, high));
  };
  constexpr double kSunk_m = 0.01;
  for (double y = -shell.back; y < shell.front - 1.2;) {
    const int kind = dice.integer(0, 3);
    const double width = kind == 0 ? dice.between(0.1, 0.35) : dice.between(0.4, 0.95);
    const Vector3d draw = dice.vector({0, 0, 0}, {1, 1, 1});
    if (kind == 0)
      add_if_clear(
          layout, "pilaster",
          at_wall_box(y, width, 0.05 + 0.2 * draw.x(), -shell.down - kSunk_m, shell.up + kSunk_m));
    else if (kind == 1)
      add_if_clear(layout, "door",
                   at_wall_box(y, width, 0.04, -shell.down - kSunk_m,
                               std::min(shell.up - 0.1, 2.05 - shell.down)));
    else if (kind == 2)
      add_if_clear(layout, "box",
                   at_wall_box(y, width, 0.15 + 0.25 * draw.x(), -shell.down - kSunk_m,
                               -shell.down + 0.2 + 0.9 * draw.y()));
    else
      add_if_clear(layout, "frame",
                   at_wall_box(y, width, 0.03, -0.5 * draw.x(), 0.3 + 0.4 * draw.y()));
    y += width + dice.between(0.15, 0.8);
  }
}

}  // namespace

void build_corridor(WorldLayout& layout) {
  WorldDice dice = layout.dice(kCorridorStream);
  layout.close(draw_corridor(dice));
  const WorldShell& shell = layout.shell();
  line_wall(layout, dice, -1);
  line_wall(layout, dice, 1);
  for (double y = dice.between(0.3, 1.5); y < shell.front - 0.5; y += dice.between(0.9, 2.2)) {
    const double depth = dice.between(0.06, 0.2), width = dice.between(0.1, 0.3);
    add_if_clear(layout, "beam",
                 {Vector3d(-shell.left - 0.03, y, shell.up - depth),
                  Vector3d(shell.right + 0.03, y + width, shell.up + 0.03)});
  }
  // Before the end wall.
  for (int i = 0; i < 4; ++i) {
    const double x = dice.between(-0.9, 0.5), width = dice.between(0.2, 0.5);
    const double y = shell.front - dice.between(0.3, 2.5);
    const double high = -shell.down + dice.between(0.3, 1.8);
    if (!layout.take(layout.world_from_shell() * Vector3d(x, y, 0), 0.6 * width)) continue;
    add_if_clear(layout, "box",
                 {Vector3d(x, y, -shell.down - 0.01), Vector3d(x + width, y + 0.27, high)});
  }
}

}  // namespace saccade
