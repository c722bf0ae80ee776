#pragma once

#include <span>

#include "core/camera.h"
#include "core/image.h"
#include "eval/metrics/depth_metrics.h"
#include "eval/picture/canvas/colour.h"
#include "eval/picture/image/image_picture.h"

namespace saccade {

/// depth_range() of sparse depths.
[[nodiscard]] DepthRange depth_range(std::span<const DepthPoint> points);

/// Sparse depths of a view as squares somewhat larger than a pixel, coloured like draw_depth(),
/// with a colour bar (thesis figs. 8.9-8.11 a).
[[nodiscard]] ImageRgb8 draw_depth_points(std::span<const DepthPoint> points,
                                          const PinholeCamera& camera, const DepthRange& range,
                                          int upscale, const Theme& theme);

/// A dense depth map at the same size, with the same bar (figs. 8.9 and 8.10 b).
[[nodiscard]] ImageRgb8 draw_depth_map(const ImageF& depth, const DepthRange& range, int upscale,
                                       const Theme& theme);

/// The relative errors of the scored points, from 0 (dark) to `max_relative` and more (bright)
/// (figs. 8.9 and 8.10 below).
[[nodiscard]] ImageRgb8 draw_depth_errors(const DepthErrors& errors, const PinholeCamera& camera,
                                          double max_relative, int upscale, const Theme& theme);

/// The points seen from above (fig. 8.11 b): along the vertical axis of the view, its camera at the
/// lower edge looking up, with a scale bar. `points` in the camera's frame [m].
[[nodiscard]] ImageRgb8 draw_top_down(std::span<const Eigen::Vector3d> points, int width,
                                      int height, const Theme& theme);

}  // namespace saccade
