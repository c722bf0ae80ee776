#pragma once

#include <filesystem>

#include "estimator/odometry/start/bootstrap.h"

namespace saccade {

/// Writes start.yaml: what a start that was found from events alone rests on. `depth_m` is what its
/// typical depth was called.
void write_start(const std::filesystem::path& file, const Bootstrap& start, double depth_m);

}  // namespace saccade
