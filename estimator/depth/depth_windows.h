#pragma once

#include <span>
#include <vector>

#include "core/trajectory.h"
#include "estimator/depth/depth_config.h"
#include "estimator/depth/depth_estimator.h"

namespace saccade {

/// Those of the events that lie within the poses' time: beyond it no pose is known.
[[nodiscard]] std::span<const Event> within(std::span<const Event> events,
                                            const Trajectory& trajectory);

/// Cuts the stream into consecutive windows that together hold all of it, as few and as even as the
/// longest allowed. Windows without events, where the camera stood still, are left out.
/// `trajectory` spans the events and outlives the windows.
[[nodiscard]] std::vector<DepthWindow> cut_windows(std::span<const Event> events,
                                                   const Trajectory& trajectory,
                                                   const DepthWindowOptions& options);

}  // namespace saccade
