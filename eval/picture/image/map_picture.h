#pragma once

#include <span>
#include <vector>

#include "core/camera.h"
#include "core/event.h"
#include "core/image.h"
#include "core/rigid3.h"
#include "eval/picture/canvas/colour.h"

namespace saccade {

/// Pixels of the map points that the camera sees: in front of it, inside the image, and not more
/// than 5 % behind a point that falls within 1.5 px.
[[nodiscard]] std::vector<Eigen::Vector2d> visible_points(
    std::span<const Eigen::Vector3f> points_in_world, const Rigid3& world_from_camera,
    const PinholeCamera& camera);

/// The tracked map over the events of its time (thesis fig. 8.8): both as coloured light that adds
/// up on a dark ground (or as ink on a light one), so that map and events that meet show a third
/// colour. `events` undistorted; one sensor pixel is `upscale` x `upscale` pixels, map points are
/// squares of one sensor pixel at their sub-pixel position.
[[nodiscard]] ImageRgb8 draw_map_over_events(std::span<const Event> events,
                                             std::span<const Eigen::Vector2d> map_pixels,
                                             const PinholeCamera& camera, int upscale,
                                             const Theme& theme);

}  // namespace saccade
