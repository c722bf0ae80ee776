#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/image.h"
#include "core/rigid3.h"
#include "estimator/lanes.h"
#include "estimator/tracking/map_view.h"
#include "estimator/tracking/posterior_pose.h"

namespace saccade {

/// What an event says: at its instant its pixel saw this log intensity.
struct EventMeasurement {
  Eigen::Vector2f pixel;  ///< undistorted [px]
  float time_s;           ///< after the instant of the pose that is sought
  float level;            ///< log intensity
  float trust;            ///< weight, 0..1
};

/// Up to kCapacity events on their way through an iteration of the intensity aligner, structure of
/// arrays in single precision, so that all of it is vector code.
class EventChunk {
 public:
  static constexpr int kCapacity = 256;

  [[nodiscard]] int size() const { return count_; }
  void clear() { count_ = 0; }
  /// `seen`: near the pixel, at the sought pose nearly under it.
  void add(const EventMeasurement& event, const SeenPlace& seen);

  /// Where the map stands and how the camera moves while the events happen: its velocity (v, w) in
  /// its own frame [m/s, rad/s].
  struct Motion {
    Eigen::Matrix3f rotation;     ///< camera from map
    Eigen::Vector3f translation;  ///< the same [m]
    Eigen::Matrix<float, 6, 1> velocity;
  };

  /// Residuals r = level - L(place) with L the map's log intensity where the events' pixels look,
  ///   place = seen place + scale (pixel - pi(p)),   p = p_c - t (v + w x p_c),   p_c = R P + t_c
  /// and the rows of the Jacobian of L by the camera's own small motion, (a, b) = fx, fy times the
  /// map's slope in the image:
  ///   J = (a/Z, b/Z, -(a x + b y)/Z, -y (a x + b y) - b, x (a x + b y) + a, b x - a y),
  /// where the turn w t within the events' time is left out.
  void evaluate(const PinholeCamera& camera, const ImageF& atlas, const Motion& motion);

  /// What residuals deviate by: sigma^2 = level^2 + (place_px |grad L|)^2.
  struct Noise {
    float level;     ///< [log units]
    float place_px;  ///< of what a map of point samples shows between them
  };
  /// Weights trust (level / sigma)^2 / (1 + (r / (2.4 sigma))^2) (Cauchy): at most 1, where
  /// the map is flat; 0 where nothing of it is seen.
  void weigh(const Noise& noise);

  struct Sums : PoseEquations {
    double weight = 0;   ///< trust / (1 + (r / (2.4 sigma))^2)
    double squares = 0;  ///< r^2 by this weight
    double visible = 0;  ///< events that see a known place, by trust
    double inliers = 0;  ///< of them those within 2.4 sigma
    double trust = 0;
  };
  void add_to(Sums& sums);

  /// Of event `i`, after evaluate(): level above the map; NaN where nothing of it is seen.
  [[nodiscard]] float residual(int i) const;

 private:
  using Floats = std::array<float, kCapacity>;
  [[nodiscard]] std::size_t padded() const {
    return padded_to_lanes(static_cast<std::size_t>(count_));
  }
  void read(const ImageF& atlas);

  int count_ = 0;
  alignas(64) Floats point_x_{}, point_y_{}, point_z_{};
  alignas(64) Floats pixel_x_{}, pixel_y_{}, time_s_{}, level_{}, trust_{};
  alignas(64) Floats place_x_{}, place_y_{}, scale_xx_{}, scale_xy_{}, scale_yx_{}, scale_yy_{};
  alignas(64) Floats ray_x_{}, ray_y_{}, inverse_depth_{};
  alignas(64) Floats at_x_{}, at_y_{}, visible_{}, residual_{}, relative_{}, weight_{};
  alignas(64) Floats slope_x_{}, slope_y_{};
  alignas(64) std::array<std::int32_t, kCapacity> cell_{};
  alignas(64) std::array<Floats, 6> columns_{}, weighted_{};
};

}  // namespace saccade
