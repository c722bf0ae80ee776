#pragma once

#include "simulator/scene/scene.h"
#include "simulator/sensor/ray_view.h"

namespace saccade {

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

}  // namespace saccade
