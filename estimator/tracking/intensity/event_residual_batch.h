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

/// A pixel saw this log intensity at some instant.
struct LogIntensityObservation {
  Eigen::Vector2f pixel;  ///< undistorted [px]
  float time_s;           ///< after the instant of the pose that is sought
  float log_intensity;
  float variance;  ///< of the log intensity [log units^2]
  /// All log intensities within so much of it are as likely [log units]: only what is farther off is
  /// a residual. What is not agrees with the map, as evidence, and says nothing of the pose.
  float dead_zone = 0;
  float region_weight = 1;  ///< 0..1: factor of its weight in the equations (RegionWeights)
};

/// Up to kCapacity observations in an iteration of the intensity tracker, structure of
/// arrays in single precision, so that all of it is vector code.
class EventResidualBatch {
 public:
  static constexpr int kCapacity = 256;

  [[nodiscard]] int size() const { return count_; }
  void clear() { count_ = 0; }
  /// `at`: the map near the pixel's reprojection at the sought pose.
  void add(const LogIntensityObservation& observation, const MapSample& at);

  /// Pose of the map, and how the camera moves while the events happen: its velocity (v, w) in
  /// its own frame [m/s, rad/s].
  struct Motion {
    Eigen::Matrix3f rotation;     ///< camera from map
    Eigen::Vector3f translation;  ///< the same [m]
    Eigen::Matrix<float, 6, 1> velocity;
  };

  /// Residuals r = l - L(a) of the observed log intensity l, or of the nearest one within its dead zone,
  /// from the map's at the reprojection a,
  ///   a = atlas_px + atlas_per_pixel (pixel - pi(p)),
  ///   p = p_c - t (v + w x p_c),   p_c = R P + t_c
  /// and the rows of the Jacobian of L by the camera's own small motion, (a, b) = fx, fy times the
  /// map's slope in the image:
  ///   J = (a/Z, b/Z, -(a x + b y)/Z, -y (a x + b y) - b, x (a x + b y) + a, b x - a y),
  /// where the rotation w t within the events' time is left out. `variance` is that of the map's
  /// positions (IntensityMap::variance()).
  void evaluate(const PinholeCamera& camera, const ImageF& atlas, const ImageF& variance,
                const Motion& motion);

  /// What the map does not say of an observation.
  struct MapNoise {
    float sigma;              ///< n: texture between the map's point samples [log units]
    float position_sigma_px;  ///< s: where between two samples an edge is
  };

  /// Weights region_weight (n / sigma)^2 / (1 + (r / (2.4 sigma))^2) (Cauchy) with
  ///   sigma^2 = P + R,   R = n^2 + s^2 IntensityMap::variance()
  /// and P the observation's own variance: at most 1, where the map is flat and the pixel's log
  /// intensity is exact; 0 where the map is not visible.
  void weigh(const MapNoise& noise);

  struct Sums : PoseEquations {
    double known = 0;    ///< n^2 / (n^2 + P) of the observations where the map is visible
    double inliers = 0;  ///< the same of those within 2.4 sigma
    double weight = 0;   ///< the same by 1 / (1 + (r / (2.4 sigma))^2)
    double squares = 0;  ///< r^2 by this weight
  };
  void add_to(Sums& sums);

  /// Of observation `i`, after weigh(): the residual, NaN where the map is not visible; the variance
  /// R of the map; and what it holds per px^2 of a position's.
  [[nodiscard]] float residual(int i) const;
  [[nodiscard]] float log_intensity(int i) const;  ///< l
  [[nodiscard]] float map_variance(int i) const;
  [[nodiscard]] float variance_per_px2(int i) const;
  /// (r / (2.4 sigma))^2, and how much that says: n^2 / (n^2 + P), 0 where the map is not visible.
  [[nodiscard]] float relative(int i) const;
  [[nodiscard]] float certainty(int i) const;

 private:
  using Floats = std::array<float, kCapacity>;
  [[nodiscard]] std::size_t padded() const {
    return padded_to_lanes(static_cast<std::size_t>(count_));
  }
  void read(const ImageF& atlas, const ImageF& variance);

  int count_ = 0;
  alignas(64) Floats point_x_{}, point_y_{}, point_z_{};
  alignas(64) Floats pixel_x_{}, pixel_y_{}, time_s_{}, log_intensity_{}, variance_{};
  alignas(64) Floats dead_zone_{}, region_weight_{};
  alignas(64) Floats atlas_x_{}, atlas_y_{}, scale_xx_{}, scale_xy_{}, scale_yx_{}, scale_yy_{};
  alignas(64) Floats ray_x_{}, ray_y_{}, inverse_depth_{};
  alignas(64) Floats at_x_{}, at_y_{}, visible_{}, residual_{}, relative_{}, weight_{}, known_{};
  alignas(64) Floats slope_x_{}, slope_y_{}, variation_{}, map_variance_{};
  alignas(64) std::array<std::int32_t, kCapacity> cell_{};
  alignas(64) std::array<Floats, 6> columns_{}, weighted_{};
};

}  // namespace saccade
