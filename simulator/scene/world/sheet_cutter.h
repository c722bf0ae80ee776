#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "simulator/scene/world/world_dice.h"

namespace saccade {

/// A piece of one of a world's textures: takes metres on a surface to texture coordinates.
struct SheetCut {
  std::uint32_t material = 0;  ///< index of the texture and its tone among the world's materials
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();
  Eigen::Vector2d per_x = Eigen::Vector2d::Zero();  ///< [1/m]
  Eigen::Vector2d per_y = Eigen::Vector2d::Zero();  ///< [1/m]

  [[nodiscard]] Eigen::Vector2d uv(double x_m, double y_m) const {
    return origin + x_m * per_x + y_m * per_y;
  }
};

/// Cuts surfaces out of a few textures, each at a place of its own, turned by quarter turns and
/// mirrored by chance: so a world shows few textures without showing the same twice. A surface lies
/// within its texture. What is large, and therefore far, shows it enlarged up to 2.5 times; what is
/// larger than the texture stretches it.
class SheetCutter {
 public:
  /// `sizes_m`: width and height of what each texture covers. `tones`: in how many the textures
  /// come; material k shows texture k % sizes.
  SheetCutter(std::vector<Eigen::Vector2d> sizes_m, int tones, WorldDice dice)
      : sizes_m_(std::move(sizes_m)), tones_(tones), dice_(dice) {}

  /// For a surface of that size, whose points have coordinates from 0 on.
  [[nodiscard]] SheetCut cut(double width_m, double height_m) {
    SheetCut cut;
    const int count = static_cast<int>(sizes_m_.size());
    cut.material = static_cast<std::uint32_t>(dice_.integer(0, count * tones_ - 1));
    const Eigen::Vector2d& sheet = sizes_m_[cut.material % sizes_m_.size()];
    const bool is_turned = dice_.chance(0.5);
    const Eigen::Vector2d size =
        is_turned ? Eigen::Vector2d(height_m, width_m) : Eigen::Vector2d(width_m, height_m);
    const double enlarged =
        dice_.log_between(1, std::min(width_m, height_m) > kLarge_m ? 2.5 : 1.3);
    const double scale = std::min(1 / enlarged, sheet.cwiseQuotient(size).minCoeff());
    Eigen::Vector2d per_u = scale * Eigen::Vector2d::UnitX() / sheet.x();
    Eigen::Vector2d per_v = scale * Eigen::Vector2d::UnitY() / sheet.y();
    const Eigen::Vector2d extent = scale * size.cwiseQuotient(sheet);
    cut.origin = {dice_.uniform() * (1 - extent.x()), dice_.uniform() * (1 - extent.y())};
    if (dice_.chance(0.5)) {
      cut.origin.x() += extent.x();
      per_u = -per_u;
    }
    cut.per_x = is_turned ? per_v : per_u;
    cut.per_y = is_turned ? per_u : per_v;
    return cut;
  }

 private:
  static constexpr double kLarge_m = 1;

  std::vector<Eigen::Vector2d> sizes_m_;
  int tones_;
  WorldDice dice_;
};

}  // namespace saccade
