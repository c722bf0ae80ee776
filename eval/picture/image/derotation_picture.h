#pragma once

#include <span>

#include "core/camera.h"
#include "core/event.h"
#include "core/image.h"
#include "core/trajectory.h"

namespace saccade {

/// The number of events per undistorted pixel, bilinearly distributed over the four nearest pixels;
/// events outside the image are dropped. `camera` with its lens.
[[nodiscard]] ImageF count_events(std::span<const Event> events, const PinholeCamera& camera);

/// The same after every event was rotated into the orientation of the camera at `reference_s`,
/// pi(R^-1 R_k pi^-1(u_k)) (thesis 5.15), with R_k at the event's own time. The remaining motion
/// blur is that of the translation. `world_from_camera` is not empty.
[[nodiscard]] ImageF count_derotated_events(std::span<const Event> events,
                                            const PinholeCamera& camera,
                                            const Trajectory& world_from_camera,
                                            double reference_s);

}  // namespace saccade
