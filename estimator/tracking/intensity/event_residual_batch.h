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
#include "estimator/tracking/pose_solver.h"

namespace saccade {

/// At the instant of an event its pixel saw this log intensity.
struct LogIntensityObservation {
  Eigen::Vector2f pixel;  ///< undistorted [px]
  float time_s;           ///< after the instant of the pose that is sought
  float log_intensity;
  float confidence;  ///< weight, 0..1
};

/// Up to kCapacity events in an iteration of the intensity tracker, structure of
/// arrays in single precision, so that all of it is vector code.
class EventResidualBatch {
 public:
  static constexpr int kCapacity = 256;

  [[nodiscard]] int size() const { return count_; }
  void clear() { count_ = 0; }
  /// `at`: the map near the pixel's reprojection at the sought pose.
  void add(const LogIntensityObservation& event, const MapSample& at);

  /// Pose of the map, and how the camera moves while the events happen: its velocity (v, w) in
  /// its own frame [m/s, rad/s].
  struct Motion {
    Eigen::Matrix3f rotation;     ///< camera from map
    Eigen::Vector3f translation;  ///< the same [m]
    Eigen::Matrix<float, 6, 1> velocity;
  };

  /// Residuals r = l - L(a) of the observed log intensity l from the map's at the reprojection a,
  ///   a = atlas_px + atlas_per_pixel (pixel - pi(p)),
  ///   p = p_c - t (v + w x p_c),   p_c = R P + t_c
  /// and the rows of the Jacobian of L by the camera's own small motion, (a, b) = fx, fy times the
  /// map's slope in the image:
  ///   J = (a/Z, b/Z, -(a x + b y)/Z, -y (a x + b y) - b, x (a x + b y) + a, b x - a y),
  /// where the rotation w t within the events' time is left out.
  void evaluate(const PinholeCamera& camera, const ImageF& atlas, const Motion& motion);

  /// Weights confidence (n / sigma)^2 / (1 + (r / (2.4 sigma))^2) (Cauchy) with
  ///   sigma^2 = n^2 + (s |grad L|)^2,
  /// n = `sigma` [log units] and s = `position_sigma_px` of a map of point samples: at most 1, where
  /// the map is flat; 0 where it is not visible.
  void weigh(float sigma, float position_sigma_px);

  struct Sums : PoseEquations {
    double weight = 0;   ///< confidence / (1 + (r / (2.4 sigma))^2)
    double squares = 0;  ///< r^2 by this weight
    double visible = 0;  ///< events where the map is visible, by confidence
    double inliers = 0;  ///< of them those within 2.4 sigma
    double confidence = 0;
  };
  void add_to(Sums& sums);

  /// Of event `i`, after evaluate(); NaN where the map is not visible.
  [[nodiscard]] float residual(int i) const;

 private:
  using Floats = std::array<float, kCapacity>;
  [[nodiscard]] std::size_t padded() const {
    return padded_to_lanes(static_cast<std::size_t>(count_));
  }
  void read(const ImageF& atlas);

  int count_ = 0;
  alignas(64) Floats point_x_{}, point_y_{}, point_z_{};
  alignas(64) Floats pixel_x_{}, pixel_y_{}, time_s_{}, log_intensity_{}, confidence_{};
  alignas(64) Floats atlas_x_{}, atlas_y_{}, scale_xx_{}, scale_xy_{}, scale_yx_{}, scale_yy_{};
  alignas(64) Floats ray_x_{}, ray_y_{}, inverse_depth_{};
  alignas(64) Floats at_x_{}, at_y_{}, visible_{}, residual_{}, relative_{}, weight_{};
  alignas(64) Floats slope_x_{}, slope_y_{};
  alignas(64) std::array<std::int32_t, kCapacity> cell_{};
  alignas(64) std::array<Floats, 6> columns_{}, weighted_{};
};

}  // namespace saccade
