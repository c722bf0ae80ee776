#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "core/imu_sample.h"

namespace saccade {

/// Lines `t ax ay az gx gy gz`: seconds, specific force [m/s^2], angular velocity [rad/s]. Times
/// must increase; InputError with `file:line`.
[[nodiscard]] std::vector<ImuSample> read_imu(const std::filesystem::path& file);
void write_imu(const std::filesystem::path& file, std::span<const ImuSample> samples);

}  // namespace saccade
