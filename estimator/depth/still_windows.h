#pragma once

#include <vector>

#include "core/camera.h"
#include "core/io/dataset/dataset.h"
#include "estimator/run/view_windows.h"

namespace saccade {

/// How much the camera must translate within a window, and what the image shows of it.
struct ParallaxDemand {
  PinholeCamera camera;
  double mean_depth_m = 1;  ///< > 0, of the scene
  double least_px = 0;      ///< by which the translation moves points at that depth
};

/// Joins consecutive windows over which the camera translates too little to tell depths, until it has
/// moved far enough. Not more than five, so that cost and memory stay bounded while it rests, and not
/// where it turns by more than half its field of view, since most of what the windows at the ends see
/// would lie outside the view. What is left at the end joins the windows before it where that is
/// allowed. `windows` as of cut_windows() with the same `options` and `frames`, which place the views
/// of the joined ones.
[[nodiscard]] std::vector<ViewWindow> join_still_windows(
    const std::vector<ViewWindow>& windows, const ParallaxDemand& demand,
    const ViewWindowOptions& options, const std::vector<StampedFile>& frames = {});

}  // namespace saccade
