#pragma once

// What an inertial sensor reads along a motion in closed form.

#include <cmath>
#include <cstdint>
#include <functional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/imu_sample.h"
#include "core/random.h"
#include "core/rigid3.h"
#include "tests/unit/estimator/imu/upright.h"

namespace saccade::testing {

/// The sensor in the world over time [s].
struct ImuMotion {
  std::function<Eigen::Quaterniond(double)> orientation;
  std::function<Eigen::Vector3d(double)> acceleration;  ///< [m/s^2]
};

struct ImuErrors {
  Eigen::Vector3d rate_bias{0.004, -0.003, 0.002};
  Eigen::Vector3d force_bias{0.03, -0.02, 0.04};
  double rate_noise = 1e-4;   ///< [rad/s/sqrt(Hz)]
  double force_noise = 1e-2;  ///< [m/s^2/sqrt(Hz)]
};

/// `errors` with biases that are drawn by the seed, of these sigmas per component.
inline ImuErrors with_biases(ImuErrors errors, std::uint64_t seed, double rate_sigma,
                             double force_sigma) {
  const Random random(seed);
  for (int k = 0; k < 3; ++k) {
    const auto axis = static_cast<std::uint64_t>(k);
    errors.rate_bias[k] = rate_sigma * random.normal(100, axis);
    errors.force_bias[k] = force_sigma * random.normal(101, axis);
  }
  return errors;
}

constexpr double kReading_s = 1e-3;  ///< from one reading to the next

/// The i-th reading; its noise depends on the seed alone.
inline ImuSample reading(const ImuMotion& motion, int i, std::uint64_t seed,
                         const ImuErrors& errors) {
  const Random random(seed);
  const auto normal3 = [&](std::uint64_t stream) {
    const auto k = static_cast<std::uint64_t>(i);
    return Eigen::Vector3d(random.normal(stream, k), random.normal(stream + 1, k),
                           random.normal(stream + 2, k));
  };
  const double t_s = i * kReading_s;
  constexpr double kDelta_s = 1e-5;
  ImuSample sample;
  sample.t_ns = static_cast<TimeNs>(i) * 1'000'000;
  sample.specific_force = motion.orientation(t_s).conjugate() * (motion.acceleration(t_s) + kUp) +
                          errors.force_bias +
                          errors.force_noise / std::sqrt(kReading_s) * normal3(0);
  sample.angular_velocity =
      so3_log(motion.orientation(t_s - kDelta_s).conjugate() * motion.orientation(t_s + kDelta_s)) /
          (2 * kDelta_s) +
      errors.rate_bias + errors.rate_noise / std::sqrt(kReading_s) * normal3(3);
  return sample;
}

/// Angle between the vertical of an estimate and the true one at `t_s` [rad].
inline double tilt_error(const ImuMotion& motion, const Eigen::Quaterniond& estimate, double t_s) {
  const Eigen::Vector3d up =
      estimate * motion.orientation(t_s).conjugate() * Eigen::Vector3d::UnitZ();
  return std::atan2(std::hypot(up.x(), up.y()), up.z());
}

/// A thing in a hand: some 3 m/s^2, 0.5 m/s, turning to and fro.
inline ImuMotion hand_motion() {
  return {[](double t_s) {
            return so3_exp({0.5 * std::sin(2 * t_s), 0.6 * std::sin(1.3 * t_s + 1),
                            0.4 * std::sin(3 * t_s)}) *
                   so3_exp({1.2, 0.1, -0.4});
          },
          [](double t_s) {
            return Eigen::Vector3d(-3 * std::sin(5 * t_s), -2.5 * std::sin(7 * t_s + 0.5),
                                   -3 * std::cos(6 * t_s));
          }};
}

/// Of a gyroscope whose bias nobody knows.
inline const ImuErrors kUnknownBias{{0.05, -0.04, 0.03}, {0.03, -0.02, 0.04}, 1e-3, 1e-2};

/// Turned slowly, so that the tilt changes, too, by a hand that hardly trembles.
inline ImuMotion gentle_motion() {
  return {[](double t_s) {
            return so3_exp({1.2, 0.1, -0.4}) * so3_exp({0, 0, 0.6 * t_s});
          },
          [](double t_s) {
            return Eigen::Vector3d(0.1 * std::sin(9 * t_s), 0.1 * std::sin(11 * t_s + 0.5),
                                   0.1 * std::cos(8 * t_s));
          }};
}

}  // namespace saccade::testing
