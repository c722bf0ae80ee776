#include "simulator/scene/world/world_layout.h"

#include <algorithm>
#include <cmath>

#include "simulator/scene/world/world_options.h"
#include "simulator/scene/world/world_shapes.h"

namespace saccade {
namespace {

using Eigen::Vector3d;

/// Walls go through one another by this much: no ray slips between them.
constexpr double kOverlap_m = 0.02;
/// A margin for the rounding of vertices to single precision.
constexpr double kMargin_m = 0.02;

constexpr std::uint64_t kPanelStream = 1000;

}  // namespace

Eigen::Isometry3d placed_at(const Vector3d& position, const Eigen::Matrix3d& rotation) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = rotation;
  pose.translation() = position;
  return pose;
}

WorldLayout::WorldLayout(std::uint64_t seed, SheetCutter& cutter) : seed_(seed), cutter_(cutter) {
  keep_out(Vector3d::Zero(), kWorldFreeRadius_m);
}

/// Panels of a wall share the corners of one lattice, so that they meet without gaps.
void WorldLayout::add_wall(const char* name, const Vector3d& corner, const Vector3d& along,
                           const Vector3d& up, WorldDice& dice) {
  const int columns = std::max(1, static_cast<int>(along.norm() / dice.between(1.6, 3.0)));
  const int rows = std::max(1, static_cast<int>(up.norm() / dice.between(1.6, 3.0)));
  const auto node = [&](int i, int j) -> Vector3d {
    return corner + (static_cast<double>(i) / columns) * along +
           (static_cast<double>(j) / rows) * up;
  };
  Mesh mesh;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i)
      add_face(mesh, node(i, j), node(i + 1, j) - node(i, j), node(i, j + 1) - node(i, j), cutter_);
  add(name, std::move(mesh), world_from_shell_);
}

void WorldLayout::close(const WorldShell& shell) {
  shell_ = shell;
  world_from_shell_ = placed_at(Vector3d::Zero(), turn_by_slope(shell.turn));
  WorldDice dice = this->dice(kPanelStream);
  const Vector3d low(-shell.left, -shell.back, -shell.down),
      high(shell.right, shell.front, shell.up);
  const Vector3d size = high - low;
  const auto wall = [&](const char* name, int normal, double at, int x, int y) {
    Vector3d corner = low - Vector3d::Constant(kOverlap_m);
    corner[normal] = at;
    Vector3d along = Vector3d::Zero(), up = Vector3d::Zero();
    along[x] = size[x] + 2 * kOverlap_m;
    up[y] = size[y] + 2 * kOverlap_m;
    add_wall(name, corner, along, up, dice);
  };
  wall("front wall", 1, high.y(), 0, 2);
  wall("back wall", 1, low.y(), 0, 2);
  wall("left wall", 0, low.x(), 1, 2);
  wall("right wall", 0, high.x(), 1, 2);
  wall("floor", 2, low.z(), 0, 1);
  wall("ceiling", 2, high.z(), 0, 1);
}

bool WorldLayout::is_clear(const Vector3d& centre, double radius) const {
  return std::ranges::all_of(free_, [&](const Ball& ball) {
    return (ball.centre - centre).norm() >= ball.radius + radius + kMargin_m;
  });
}

bool WorldLayout::is_clear(const Eigen::AlignedBox3d& box,
                           const Eigen::Isometry3d& world_from_box) const {
  const Eigen::Isometry3d box_from_world = world_from_box.inverse();
  return std::ranges::all_of(free_, [&](const Ball& ball) {
    const Vector3d centre = box_from_world * ball.centre;
    return box.exteriorDistance(centre) >= ball.radius + kMargin_m;
  });
}

bool WorldLayout::is_clear(const Mesh& mesh, const Eigen::Isometry3d& world_from_mesh) const {
  return std::ranges::all_of(mesh.vertices, [&](const Vector3d& vertex) {
    return is_clear(Vector3d(world_from_mesh * vertex), 0);
  });
}

bool WorldLayout::is_inside(const Vector3d& centre, double radius) const {
  const Vector3d at = world_from_shell_.inverse() * centre;
  return at.x() > radius - shell_.left && at.x() < shell_.right - radius &&
         at.y() > radius - shell_.back && at.y() < shell_.front - radius &&
         at.z() > radius - shell_.down && at.z() < shell_.up - radius;
}

bool WorldLayout::take(const Vector3d& centre, double radius) {
  const bool is_taken = std::ranges::any_of(taken_, [&](const Ball& ball) {
    return (ball.centre - centre).norm() < ball.radius + radius;
  });
  if (!is_taken) taken_.push_back({centre, radius});
  return !is_taken;
}

void WorldLayout::add(std::string name, Mesh mesh, const Eigen::Isometry3d& world_from_mesh) {
  parts_.push_back({std::move(name), std::move(mesh), world_from_mesh, std::nullopt});
}

void WorldLayout::add_moving(std::string name, Mesh mesh, MotionOptions trajectory) {
  parts_.push_back(
      {std::move(name), std::move(mesh), Eigen::Isometry3d::Identity(), std::move(trajectory)});
}

}  // namespace saccade
