#include <cmath>
#include <utility>

#include "simulator/scene/world/world_geometry.h"
#include "simulator/scene/world/world_shapes.h"

namespace saccade {
namespace {

using Eigen::Vector3d;

constexpr std::uint64_t kClutterStream = 2000;

/// Near things are small: all take a similar part of the view.
double draw_radius(WorldDice& dice, double distance) {
  return dice.log_between(0.05, 0.2) * std::pow(distance, 0.8);
}

/// Lower end of a mesh as it is turned.
double lowest(const Mesh& mesh, const Eigen::Matrix3d& rotation) {
  double z = 0;
  for (const Vector3d& vertex : mesh.vertices) z = std::min(z, (rotation * vertex).z());
  return z;
}

}  // namespace

void build_clutter(WorldLayout& layout) {
  constexpr int kSolids = 130, kAttempts = 700;
  constexpr double kSunk_m = 0.01;  // into the floor, so that no two faces lie in one plane
  WorldDice dice = layout.dice(kClutterStream);
  layout.close(draw_wide_shell(dice));
  const WorldShell& shell = layout.shell();
  for (int attempt = 0, placed = 0; attempt < kAttempts && placed < kSolids; ++attempt) {
    Vector3d centre = draw_place_in_view(dice, 1.3, 0.95 * shell.front);
    const double radius = draw_radius(dice, centre.y());
    const bool stands = dice.chance(0.35);
    const Eigen::Matrix3d rotation = stands ? turn_by_slope(dice.between(-3, 3)) : dice.rotation();
    if (stands) centre.z() = radius - shell.down;
    if (!layout.is_inside(centre, 0.99 * radius) || !layout.is_clear(centre, radius) ||
        !layout.take(centre, radius))
      continue;
    Mesh mesh = draw_solid(dice, radius, layout.cutter());
    if (stands) centre.z() = -shell.down - lowest(mesh, rotation) - kSunk_m;
    layout.add("solid", std::move(mesh), placed_at(centre, rotation));
    ++placed;
  }
}

}  // namespace saccade
