#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/imu_sample.h"
#include "estimator/imu/gyro_bias_estimator.h"

namespace saccade {

struct ComplementaryOptions {
  /// Angular velocity that stands for the interval between two samples.
  enum class Integration {
    kEnd,        ///< that of the later sample, as in the thesis: late by half an interval
    kTrapezoid,  ///< the mean of both samples
  };

  Integration integration = Integration::kTrapezoid;
  double time_constant_s = 5;  ///< tau: alpha = 1 - exp(-dt / tau)
  bool adaptive = true;        ///< adaptive gain (Valenti et al., 2015, 5.3)
  bool estimate_bias = true;   ///< (3.17)
};

/// Orientation from gyroscope and accelerometer by a complementary filter (Valenti, Dryanovski and
/// Xiao, Sensors 15(8), 2015; thesis 3.1), with q = local_from_world and a_hat = a / |a|:
///
///   q_w = q + dt (-1/2 w (x) q), normalised                                          (3.4-3.7)
///   g_p = R(q_w)^T a_hat                                                             (3.9)
///   dq  = (sqrt((g_z + 1) / 2), -g_y / sqrt(2 (g_z + 1)), g_x / sqrt(2 (g_z + 1)), 0)
///                                                                                    (3.10-3.12)
///   q   = q_w (x) interpolate(identity, dq, alpha)                                   (3.8,
///                                                                                    3.13-3.16)
///
/// The world's z axis points up. The heading starts with that of the sensor's x axis (its y axis,
/// where x is vertical), and no measurement corrects it.
class ComplementaryFilter {
 public:
  explicit ComplementaryFilter(const ComplementaryOptions& options,
                               const GyroscopeNoise& gyroscope = {});

  /// Adds a sample; the first one gives the tilt. Times increase (contract).
  void update(const ImuSample& sample);

  /// After the last sample; identity before the first.
  [[nodiscard]] Eigen::Quaterniond world_from_imu() const { return local_from_world_.conjugate(); }
  [[nodiscard]] const GyroBiasEstimator& bias() const { return bias_; }
  /// Number of gaps longer than 0.1 s between samples.
  [[nodiscard]] int gaps() const { return gaps_; }

 private:
  void predict(const ImuSample& sample, double dt_s);
  void correct(const ImuSample& sample, double gain);
  [[nodiscard]] double gain_factor(double force) const;

  ComplementaryOptions options_;
  GyroBiasEstimator bias_;
  Eigen::Quaterniond local_from_world_ = Eigen::Quaterniond::Identity();
  ImuSample last_;
  bool has_last_ = false;
  int gaps_ = 0;
};

}  // namespace saccade
