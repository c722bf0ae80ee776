#pragma once

#include <array>
#include <span>

#include "simulator/scene/scene.h"
#include "simulator/sensor/rays/pixel_rays.h"
#include "simulator/sensor/signal/ray_sample.h"

namespace saccade {

/// One number for each pixel of a tile, side by side for the compiler to vectorise.
using Lanes = std::array<double, kMaxTilePixels>;

/// Directions (x, y, 1) of the pixels of a tile with one ray each.
struct DirectionLanes {
  Lanes x{}, y{};
  std::size_t count = 0;

  DirectionLanes() = default;
  explicit DirectionLanes(std::span<const Eigen::Vector3d> directions) : count(directions.size()) {
    for (std::size_t i = 0; i < directions.size(); ++i) {
      x[i] = directions[i].x();
      y[i] = directions[i].y();
    }
  }
};

/// The places on a plane that the pixels of a tile see at an instant.
struct TexelLanes {
  Lanes x, y;            ///< texel coordinates
  Lanes x_rate, y_rate;  ///< [texel/s]
};

/// A textured or plain triangle that is static, as the rays of a camera see it one by one.
class PlaneSampler {
 public:
  /// `now` and `soon`: its map at an instant and `soon_s` later.
  PlaneSampler(const TexelHomography& now, const TexelHomography& soon, double soon_s,
               TriangleId triangle)
      : now_(now),
        x_change_((soon.x - now.x) / soon_s),
        y_change_((soon.y - now.y) / soon_s),
        w_change_((soon.w - now.w) / soon_s),
        triangle_(triangle) {}

  [[nodiscard]] TriangleId triangle() const { return triangle_; }
  /// Its texture and factor.
  [[nodiscard]] SurfaceSample surface() const { return {now_.texture, 0, 0, now_.factor}; }

  [[nodiscard]] RaySample at(const Eigen::Vector3d& direction) const {
    const double inverse = 1 / now_.w.dot(direction);
    const double slowing = w_change_.dot(direction);
    const double x = now_.x.dot(direction) * inverse;
    const double y = now_.y.dot(direction) * inverse;
    return {triangle_,
            {now_.texture, x, y, now_.factor, 1, now_.depth * inverse},
            (x_change_.dot(direction) - x * slowing) * inverse,
            (y_change_.dot(direction) - y * slowing) * inverse};
  }

  /// The same for all pixels of a tile.
  void at(const DirectionLanes& directions, TexelLanes& lanes) const {
    for (std::size_t i = 0; i < directions.count; ++i) {
      const double dx = directions.x[i];
      const double dy = directions.y[i];
      const auto along = [dx, dy](const Eigen::Vector3d& row) {
        return row[0] * dx + row[1] * dy + row[2];
      };
      const double inverse = 1 / along(now_.w);
      const double slowing = along(w_change_);
      lanes.x[i] = along(now_.x) * inverse;
      lanes.y[i] = along(now_.y) * inverse;
      lanes.x_rate[i] = (along(x_change_) - lanes.x[i] * slowing) * inverse;
      lanes.y_rate[i] = (along(y_change_) - lanes.y[i] * slowing) * inverse;
    }
  }

 private:
  TexelHomography now_;
  Eigen::Vector3d x_change_, y_change_, w_change_;
  TriangleId triangle_;
};

}  // namespace saccade
