#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "simulator/scene/scene.h"
#include "simulator/sensor/pixel_rays.h"
#include "simulator/sensor/ray_view.h"

namespace saccade {

/// The places on one plane that the pixels of a tile see at an instant, side by side for the
/// compiler to vectorise.
struct PlaneLanes {
  using Lane = std::array<double, kTilePixels>;
  Lane x, y;            ///< texel coordinates
  Lane x_rate, y_rate;  ///< [texel/s]
  Lane distance;        ///< [length of the ray's direction]
};

/// Directions (x, y, 1) of a tile's pixels.
struct DirectionLanes {
  PlaneLanes::Lane x{}, y{};

  DirectionLanes() = default;
  explicit DirectionLanes(std::span<const Eigen::Vector3d> directions) {
    for (std::size_t i = 0; i < directions.size(); ++i) {
      x[i] = directions[i].x();
      y[i] = directions[i].y();
    }
  }
};

/// `now` and `soon`: the map at an instant and `soon_s` later.
inline void look(const DirectionLanes& directions, const TexelMap& now, const TexelMap& soon,
                 double soon_s, PlaneLanes& lanes) {
  const Eigen::Vector3d x_change = (soon.x - now.x) / soon_s;
  const Eigen::Vector3d y_change = (soon.y - now.y) / soon_s;
  const Eigen::Vector3d w_change = (soon.w - now.w) / soon_s;
  for (std::size_t i = 0; i < kTilePixels; ++i) {
    const double dx = directions.x[i];
    const double dy = directions.y[i];
    const auto along = [dx, dy](const Eigen::Vector3d& row) {
      return row[0] * dx + row[1] * dy + row[2];
    };
    const double inverse = 1 / along(now.w);
    const double slowing = along(w_change);
    lanes.x[i] = along(now.x) * inverse;
    lanes.y[i] = along(now.y) * inverse;
    lanes.x_rate[i] = (along(x_change) - lanes.x[i] * slowing) * inverse;
    lanes.y_rate[i] = (along(y_change) - lanes.y[i] * slowing) * inverse;
    lanes.distance[i] = now.depth * inverse;
  }
}

/// A textured or plain triangle that stands still, as the rays of a camera see it one by one.
class PlaneView {
 public:
  /// `now` and `soon`: its map at an instant and `soon_s` later.
  PlaneView(const TexelMap& now, const TexelMap& soon, double soon_s, TriangleId triangle)
      : now_(now),
        x_change_((soon.x - now.x) / soon_s),
        y_change_((soon.y - now.y) / soon_s),
        w_change_((soon.w - now.w) / soon_s),
        triangle_(triangle) {}

  [[nodiscard]] TriangleId triangle() const { return triangle_; }

  [[nodiscard]] RayView at(const Eigen::Vector3d& direction) const {
    const double inverse = 1 / now_.w.dot(direction);
    const double slowing = w_change_.dot(direction);
    const double x = now_.x.dot(direction) * inverse;
    const double y = now_.y.dot(direction) * inverse;
    return {triangle_,
            {now_.texture, x, y, now_.factor, 1, now_.depth * inverse},
            (x_change_.dot(direction) - x * slowing) * inverse,
            (y_change_.dot(direction) - y * slowing) * inverse};
  }

 private:
  TexelMap now_;
  Eigen::Vector3d x_change_, y_change_, w_change_;
  TriangleId triangle_;
};

/// Boxes around the paths of all lanes between two instants, as radiance_range() has them.
struct LaneBoxes {
  PlaneLanes::Lane x0, x1, y0, y1;

  LaneBoxes(const PlaneLanes& from, const PlaneLanes& to, double length_s) {
    enclose(from.x, from.x_rate, to.x, to.x_rate, length_s, x0, x1);
    enclose(from.y, from.y_rate, to.y, to.y_rate, length_s, y0, y1);
  }

 private:
  static void enclose(const PlaneLanes::Lane& from, const PlaneLanes::Lane& from_rate,
                      const PlaneLanes::Lane& to, const PlaneLanes::Lane& to_rate, double length_s,
                      PlaneLanes::Lane& low, PlaneLanes::Lane& high) {
    for (std::size_t i = 0; i < kTilePixels; ++i) {
      const double chord = to[i] - from[i];
      const double stray =
          4.0 / 27 *
          (std::abs(from_rate[i] * length_s - chord) + std::abs(to_rate[i] * length_s - chord));
      low[i] = std::min(from[i], to[i]) - stray;
      high[i] = std::max(from[i], to[i]) + stray;
    }
  }
};

}  // namespace saccade
