#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/event.h"
#include "core/trajectory.h"

namespace saccade {

/// Orientations at the first event, at the last one and every ms in between; at least one event.
[[nodiscard]] std::vector<Eigen::Matrix3d> turns_of(const Trajectory& world_from_camera,
                                                    std::span<const Event> events);

}  // namespace saccade
