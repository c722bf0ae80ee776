#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "core/imu_sample.h"

namespace saccade {

/// Lines `t ax ay az gx gy gz`: seconds, specific force [m/s^2], angular velocity [rad/s]; times
/// with 9 decimals, the rest exact in double. Times must increase; InputError with `file:line`.
[[nodiscard]] std::vector<ImuSample> read_imu(const std::filesystem::path& file);
void write_imu(const std::filesystem::path& file, std::span<const ImuSample> samples);

/// Lines `t ax ay az gx gy gz bax bay baz bgx bgy bgz` below a comment that names the columns: the
/// ideal reading, then the biases of accelerometer and gyroscope; likewise.
[[nodiscard]] std::vector<ImuTruth> read_imu_truth(const std::filesystem::path& file);
void write_imu_truth(const std::filesystem::path& file, std::span<const ImuTruth> truth);

/// Lines `t bx by bz sigma at_rest` below a comment that names the columns; `at_rest` is 0 or 1.
/// Likewise.
[[nodiscard]] std::vector<GyroBiasEstimate> read_gyro_biases(const std::filesystem::path& file);
void write_gyro_biases(const std::filesystem::path& file, std::span<const GyroBiasEstimate> biases);

/// imu.yaml in Kalibr's layout (accelerometer_noise_density ... update_rate). InputError with
/// `file:line` where a key is missing or negative.
[[nodiscard]] ImuCalibration read_imu_yaml(const std::filesystem::path& file);
void write_imu_yaml(const std::filesystem::path& file, const ImuCalibration& imu);

}  // namespace saccade
