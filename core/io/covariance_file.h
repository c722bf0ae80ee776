#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "core/rigid3.h"

namespace saccade {

/// Uncertainty of a pose: the covariance of the twist (v, w) of truth^-1 estimate, in the camera's
/// axes [m, rad].
struct StampedCovariance {
  double t_s = 0;
  Matrix6 covariance = Matrix6::Zero();
};

/// Lines of `t` [s] and the 21 entries on and above the diagonal, row by row, below a comment that
/// says so. Times with 9 decimals, the rest exact in double.
void write_covariances(const std::filesystem::path& file,
                       std::span<const StampedCovariance> covariances);
/// InputError with `file:line` for malformed lines and times that do not increase.
[[nodiscard]] std::vector<StampedCovariance> read_covariances(const std::filesystem::path& file);

}  // namespace saccade
