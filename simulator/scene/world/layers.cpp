#include <cmath>
#include <utility>

#include "simulator/scene/world/world_geometry.h"
#include "simulator/scene/world/world_shapes.h"

namespace saccade {
namespace {

constexpr std::uint64_t kLayersStream = 2100;

/// The rotation that turns -y, the side towards the camera, by these slopes to the side and up.
Eigen::Matrix3d leaning(double aside, double up) {
  const Eigen::Vector3d back = Eigen::Vector3d(aside, 1, up).normalized();
  const Eigen::Vector3d x = back.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Matrix3d rotation;
  rotation << x, back, x.cross(back);
  return rotation;
}

}  // namespace

void build_layers(WorldLayout& layout) {
  constexpr int kRectangles = 44, kAttempts = 300;
  WorldDice dice = layout.dice(kLayersStream);
  layout.close(draw_wide_shell(dice));
  for (int attempt = 0, placed = 0; attempt < kAttempts && placed < kRectangles; ++attempt) {
    const Eigen::Vector3d centre = draw_place_in_view(dice, 1.25, 0.92 * layout.shell().front);
    const double width = centre.y() * dice.between(0.15, 0.5);
    const double height = centre.y() * dice.between(0.15, 0.5);
    const Eigen::Vector3d slopes = dice.vector({-0.35, -0.4, -0.25}, {0.35, 0.4, 0.25});
    const Eigen::Matrix3d rotation =
        leaning(slopes.x(), slopes.z()) *
        Eigen::Matrix3d(Eigen::AngleAxisd(slopes.y(), Eigen::Vector3d::UnitY()));
    const double radius = 0.5 * std::hypot(width, height);
    if (!layout.is_clear(centre, radius) || !layout.is_inside(centre, 0.5 * radius) ||
        !layout.take(centre, 0.5 * radius))
      continue;
    layout.add("layer", rectangle_mesh(width, height, layout.cutter()),
               placed_at(centre, rotation));
    ++placed;
  }
}

}  // namespace saccade
