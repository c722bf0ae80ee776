#pragma once

#include <span>

#include "core/camera.h"
#include "core/event.h"
#include "core/image.h"
#include "eval/picture/canvas/colour.h"

namespace saccade {

/// One pixel per sensor pixel in the ON or OFF colour of its last event; more events give a
/// stronger colour, up to three. Events outside width x height are left out.
[[nodiscard]] ImageRgb8 draw_events(std::span<const Event> events, int width, int height,
                                    const Theme& theme);

/// Events at the nearest pixel of the undistorted sensor; those that leave it are dropped.
[[nodiscard]] Events undistort_events(std::span<const Event> events, const PinholeCamera& camera);

/// The `count` events nearest in time to `t_s`, at most `max_distance_s` away, of events in order
/// of time.
[[nodiscard]] std::span<const Event> events_around(std::span<const Event> events, double t_s,
                                                   std::size_t count, double max_distance_s = 0.1);

}  // namespace saccade
