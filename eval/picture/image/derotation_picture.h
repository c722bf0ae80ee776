#pragma once

#include <span>

#include "core/camera.h"
#include "core/event.h"
#include "core/image.h"
#include "core/trajectory.h"

namespace saccade {

/// How many events fell on every undistorted pixel, each shared among the four around it; those
/// that leave the image are dropped. `camera` with its lens.
[[nodiscard]] ImageF count_events(std::span<const Event> events, const PinholeCamera& camera);

/// The same after every event was turned into the orientation that the camera had at
/// `reference_s`, pi(R^-1 R_k pi^-1(u_k)) (thesis 5.15), with the pose of its own time: what is
/// left of the motion is the translation. `world_from_camera` is not empty.
[[nodiscard]] ImageF count_derotated_events(std::span<const Event> events,
                                            const PinholeCamera& camera,
                                            const Trajectory& world_from_camera,
                                            double reference_s);

}  // namespace saccade
