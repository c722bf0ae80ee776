#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/imu_sample.h"

namespace saccade {

enum class ImuTriad { kGyroscope, kAccelerometer };

/// What noise adds to one reading of a triad.
struct TriadError {
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();
  Eigen::Vector3d white = Eigen::Vector3d::Zero();
};

/// The errors of `count` readings `dt_s` > 0 apart, independent on the three axes (Kalibr's model;
/// Trawny and Roumeliotis, "Indirect Kalman filter for 3D attitude estimation", 2005):
///   white_k ~ N(0, density^2 / dt)
///   bias_0 = turn_on_bias,   bias_k - bias_{k-1} ~ N(0, random_walk^2 dt)
/// Allan deviations are then density / sqrt(tau) and random_walk sqrt(tau / 3). Each draw belongs
/// to (seed, triad and axis, k), so that the readings of a shorter recording are the first ones of
/// a longer.
[[nodiscard]] std::vector<TriadError> triad_errors(const TriadNoise& noise,
                                                   const Eigen::Vector3d& turn_on_bias, double dt_s,
                                                   std::uint64_t seed, ImuTriad triad,
                                                   std::size_t count);

}  // namespace saccade
