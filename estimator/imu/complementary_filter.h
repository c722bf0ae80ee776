#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/event.h"
#include "core/imu_sample.h"
#include "estimator/imu/steady_bias.h"

namespace saccade {

struct ComplementaryOptions {
  /// Which rate stands for the interval from one reading to the next.
  enum class Integration {
    kEnd,        ///< that of its end, as the thesis has it: late by half an interval
    kTrapezoid,  ///< the mean of both ends
  };

  double gravity = 9.81;  ///< [m/s^2]
  Integration integration = Integration::kTrapezoid;
  double time_constant_s = 5;  ///< tau of the correction, alpha = 1 - exp(-dt / tau)
  bool adaptive = true;        ///< less correction the more | |a| - g | / g differs from 0:
  double full_trust = 0.1;     ///< all of it up to here,
  double no_trust = 0.2;       ///< none of it from here on
  double slerp_below = 0.9;    ///< dq_0 below which slerp stands in for lerp
  double max_gap_s = 0.1;      ///< after a longer one the tilt is read from the accelerometer again
  SteadyBiasOptions bias;
};

/// Orientation from gyroscope and accelerometer (Valenti et al., Sensors 15(8), 2015; thesis 3.1),
/// with q = local_from_world, a_hat = a / |a|:
///   q_w = q + dt (-1/2 w (x) q), normalised                                          (3.6, 3.7)
///   g_p = R(q_w)^T a_hat, dq = (sqrt((g_z+1)/2), -g_y/sqrt(2(g_z+1)), g_x/sqrt(2(g_z+1)), 0)
///                                                                                    (3.9-3.12)
///   q = q_w (x) interpolate(1, dq, alpha) (3.8, 3.13-3.16)
/// The world's z axis points up; its heading is that of the sensor's x axis at the start (or its y
/// axis, where x stands upright) and nothing corrects it later.
class ComplementaryFilter {
 public:
  explicit ComplementaryFilter(const ComplementaryOptions& options);

  /// Takes a reading in. The first one gives the tilt; times increase (contract).
  void update(const ImuSample& sample);

  /// After the last reading; identity before the first.
  [[nodiscard]] Eigen::Quaterniond world_from_imu() const { return local_from_world_.conjugate(); }
  [[nodiscard]] const SteadyBias& bias() const { return bias_; }
  /// How often the readings were interrupted for longer than `max_gap_s`.
  [[nodiscard]] int gaps() const { return gaps_; }

 private:
  void predict(const ImuSample& sample, double dt_s);
  void correct(const ImuSample& sample, double gain);
  [[nodiscard]] double trust(double force) const;

  ComplementaryOptions options_;
  SteadyBias bias_;
  Eigen::Quaterniond local_from_world_ = Eigen::Quaterniond::Identity();
  ImuSample last_;
  bool has_last_ = false;
  int gaps_ = 0;
};

}  // namespace saccade
