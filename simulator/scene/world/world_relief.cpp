#include <cmath>
#include <utility>

#include "simulator/scene/mesh/relief.h"
#include "simulator/scene/world/world_geometry.h"
#include "simulator/scene/world/world_shapes.h"

namespace saccade {
namespace {

using Eigen::Vector3d;

constexpr std::uint64_t kReliefStream = 2200;

ReliefOptions draw_relief(WorldDice& dice) {
  ReliefOptions options;
  options.size_m = {11, 9};
  options.seed = dice.seed();
  options.dunes.height_m = dice.between(0.1, 0.9);
  options.dunes.across = {dice.between(-1, 1), 1};
  options.dunes.wavelength_m = dice.between(1.5, 4);
  options.dunes.rise = dice.between(0.4, 0.8);
  options.dunes.bend_m = dice.between(0.2, 1);
  options.swell.height_m = dice.between(0.1, 0.5);
  options.swell.wavelength_m = {dice.between(0.4, 0.8), 4};
  return options;
}

/// One patch of the relief with a cut of its own. Patches share the corners of one lattice, so that
/// they meet without gaps.
void add_patch(Mesh& mesh, const Relief& relief, const Eigen::Vector2d& corner,
               const Eigen::Vector2d& size, SheetCutter& cutter) {
  constexpr std::uint32_t kCells = 44;
  const SheetCut cut = cutter.cut(size.x(), size.y());
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (std::uint32_t j = 0; j <= kCells; ++j)
    for (std::uint32_t i = 0; i <= kCells; ++i) {
      const Eigen::Vector2d at(size.x() * i / kCells, size.y() * j / kCells);
      const Eigen::Vector2d ground = corner + at;
      const Elevation elevation = relief.at(ground);
      mesh.vertices.emplace_back(ground.x(), ground.y(), elevation.height);
      mesh.normals.push_back(Vector3d(-elevation.slope.x(), -elevation.slope.y(), 1).normalized());
      mesh.uvs.push_back(cut.uv(at.x(), at.y()));
    }
  for (std::uint32_t j = 0; j < kCells; ++j)
    for (std::uint32_t i = 0; i < kCells; ++i) {
      const std::uint32_t at = first + j * (kCells + 1) + i;
      const std::uint32_t above = at + kCells + 1;
      mesh.triangles.push_back({{at, at + 1, above + 1}, cut.material});
      mesh.triangles.push_back({{at, above + 1, above}, cut.material});
    }
}

}  // namespace

void build_relief(WorldLayout& layout) {
  constexpr int kColumns = 5, kRows = 4;
  WorldDice dice = layout.dice(kReliefStream);
  WorldShell shell = draw_wide_shell(dice);
  shell.left = std::max(shell.left, 5.0);
  shell.right = std::max(shell.right, 5.0);
  shell.front = std::max(shell.front, 6.0);
  layout.close(shell);
  const ReliefOptions options = draw_relief(dice);
  const Relief relief(options);
  const Eigen::Vector2d size(options.size_m[0] / kColumns, options.size_m[1] / kRows);
  Mesh mesh;
  for (int j = 0; j < kRows; ++j)
    for (int i = 0; i < kColumns; ++i)
      add_patch(mesh, relief, {(i - 0.5 * kColumns) * size.x(), (j - 0.5 * kRows) * size.y()}, size,
                layout.cutter());
  // From a ground that rises to a wall that leans back.
  const double turn = dice.between(-0.3, 0.3), tilt = dice.between(0.5, 1.45);
  const Eigen::Matrix3d rotation =
      turn_by_slope(turn) * Eigen::Matrix3d(Eigen::AngleAxisd(tilt, Vector3d::UnitX()));
  Vector3d centre = dice.vector({-0.5, 2.2, -0.6}, {0.5, 3.4, 0});
  constexpr double kStep_m = 0.05;
  while (!layout.is_clear(mesh, placed_at(centre, rotation))) centre.y() += kStep_m;
  layout.add("relief", std::move(mesh), placed_at(centre, rotation));
}

}  // namespace saccade
