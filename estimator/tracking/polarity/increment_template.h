#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/rigid3.h"
#include "estimator/tracking/map_view.h"

namespace saccade {

/// Pixels of a view of the map with the brightness increment that is expected of them, structure of
/// arrays in single precision.
struct IncrementPoints {
  using Floats = std::vector<float>;
  /// What reads them may read so many behind the last one.
  static constexpr std::size_t kSpare = 16;

  std::size_t count = 0;          ///< the arrays are longer
  Floats ray_x, ray_y;            ///< x / z, y / z
  Floats inverse_depth;           ///< [1/m]
  Floats increment;               ///< M [log units/s]
  Floats slope;                   ///< |grad M| [1/px]
  std::array<Floats, 6> by_pose;  ///< dM / dxi, xi being a small motion of the points

  explicit IncrementPoints(std::size_t capacity);
};

/// What the map shows in a view, and how fast its brightness changes there when the camera moves
/// with velocity V = (v, w): with L the map's log intensity and dW/dxi the interaction matrix of
/// the points' motion,
///   M(u) = -grad L . du/dt = grad L dW/dxi V   [log units/s].
class IncrementTemplate {
 public:
  /// `camera` is undistorted.
  explicit IncrementTemplate(const PinholeCamera& camera);

  /// Takes in what a view shows. Next to what is unknown nothing is expected.
  void draw(const MapView& view, const ImageF& atlas);

  /// The pixels whose increments are steep, |grad M| >= `min_slope` times the root mean square of
  /// all; `velocity` in the view's frame [m/s, rad/s]. Valid until the next call.
  [[nodiscard]] const IncrementPoints& points(const Twist& velocity, double min_slope);

 private:
  void sample_map(const MapView& view, const ImageF& atlas);
  void expect_increments(const Twist& velocity);
  [[nodiscard]] float measure_steepness();
  void add_point(int x, int y);

  PinholeCamera camera_;
  ImageF picture_;            ///< L; NaN where it is not known
  ImageF slope_x_, slope_y_;  ///< of L [1/px]; 0 where it is not known
  ImageF inverse_depth_;      ///< [1/m]; 0 where no slope is known
  ImageF increment_;          ///< M
  ImageF steepness_;          ///< |grad M|^2; negative where it is not known
  IncrementPoints points_;
};

}  // namespace saccade
