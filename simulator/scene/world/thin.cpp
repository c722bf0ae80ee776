#include <cmath>
#include <utility>

#include "simulator/scene/world/world_geometry.h"
#include "simulator/scene/world/world_shapes.h"

namespace saccade {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::uint64_t kThinStream = 2400;
constexpr int kRodSides = 8;

/// The rotation that turns +z to `axis`.
Matrix3d along(const Vector3d& axis) {
  return Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), axis).toRotationMatrix();
}

Eigen::AlignedBox3d box_around(double x, double y, double z) {
  const Vector3d half(0.5 * x, 0.5 * y, 0.5 * z);
  return {-half, half};
}

/// A straight rod or a wire; thin ones are near.
void add_rods(WorldLayout& layout, WorldDice& dice) {
  constexpr int kRods = 60;
  for (int i = 0; i < kRods; ++i) {
    const Vector3d centre = draw_place_in_view(dice, 1.3, 0.9 * layout.shell().front);
    const double radius = dice.log_between(0.0015, 0.008) * centre.y();
    const double length = dice.between(0.4, 1.4) * centre.y();
    const Isometry3d pose = placed_at(centre, along(dice.direction()));
    if (!layout.is_clear(box_around(2 * radius, 2 * radius, length), pose)) continue;
    layout.add("rod", cylinder_mesh(radius, length, kRodSides, layout.cutter()), pose);
  }
}

/// Bars both ways, one behind the other.
void add_grille(WorldLayout& layout, WorldDice& dice) {
  const Vector3d centre = draw_place_in_view(dice, 1.5, 0.7 * layout.shell().front);
  const double width = dice.between(0.4, 0.7) * centre.y();
  const double height = dice.between(0.4, 0.7) * centre.y();
  const double bar = dice.between(0.003, 0.008) * centre.y();
  const double gap = dice.between(0.03, 0.09) * centre.y();
  const double turn = dice.between(-0.6, 0.6), roll = dice.between(-0.5, 0.5);
  const Matrix3d rotation =
      turn_by_slope(turn) * Matrix3d(Eigen::AngleAxisd(roll, Vector3d::UnitY()));
  const Isometry3d pose = placed_at(centre, rotation);
  if (!layout.is_clear(box_around(width, 3 * bar, height), pose)) return;
  Mesh mesh;
  for (double x = -0.5 * width; x <= 0.5 * width; x += gap)
    add_moved(mesh, box_mesh({bar, bar, height}, layout.cutter()),
              placed_at({x, 0, 0}, Matrix3d::Identity()));
  for (double z = -0.5 * height; z <= 0.5 * height; z += gap)
    add_moved(mesh, box_mesh({width, 0.9 * bar, 1.1 * bar}, layout.cutter()),
              placed_at({0, bar, z}, Matrix3d::Identity()));
  layout.add("grille", std::move(mesh), pose);
}

/// A twig with leaves on both sides.
void add_twig(WorldLayout& layout, WorldDice& dice) {
  const Vector3d centre = draw_place_in_view(dice, 1.35, 0.7 * layout.shell().front);
  const double length = dice.between(0.3, 0.7) * centre.y();
  const double leaf = dice.between(0.02, 0.05) * centre.y();
  const Isometry3d pose = placed_at(centre, along(dice.direction()));
  if (!layout.is_clear(box_around(2.6 * leaf, 2.6 * leaf, length + 2 * leaf), pose)) return;
  Mesh mesh = cylinder_mesh(0.06 * leaf, length, kRodSides, layout.cutter());
  const int leaves = dice.integer(12, 30);
  for (int i = 0; i < leaves; ++i) {
    const double z = length * ((i + 0.5) / leaves - 0.5);
    const Vector3d around = turn_by_slope(dice.between(-2, 2)) * Vector3d::UnitX();
    const Vector3d out = (dice.chance(0.5) ? 1.0 : -1.0) * around;
    Matrix3d rotation;
    rotation << out, Vector3d::UnitZ().cross(out), Vector3d::UnitZ();
    rotation = rotation * Matrix3d(Eigen::AngleAxisd(dice.between(-1.2, 1.2), Vector3d::UnitX()));
    const double size = dice.between(0.7, 1.0) * leaf;
    add_moved(mesh, leaf_mesh(size, dice.between(0.3, 0.6) * size, 0.1 * size, layout.cutter()),
              placed_at(0.6 * leaf * out + z * Vector3d::UnitZ(), rotation));
  }
  layout.add("twig", std::move(mesh), pose);
}

}  // namespace

void build_thin(WorldLayout& layout) {
  constexpr int kGrilles = 5, kTwigs = 26;
  WorldDice dice = layout.dice(kThinStream);
  layout.close(draw_wide_shell(dice));
  add_rods(layout, dice);
  for (int i = 0; i < kGrilles; ++i) add_grille(layout, dice);
  for (int i = 0; i < kTwigs; ++i) add_twig(layout, dice);
}

}  // namespace saccade
