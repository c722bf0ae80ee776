#pragma once

#include <filesystem>
#include <span>

#include "core/camera.h"
#include "core/event.h"
#include "core/rigid3.h"
#include "estimator/tracking/edges/edge_tracker.h"
#include "estimator/tracking/map_extraction.h"
#include "estimator/tracking/reference_view.h"

namespace saccade {

/// One pose of a run, with what it was tracked from.
struct TrackingMoment {
  std::span<const Event> events;  ///< of its frame, not empty
  Rigid3 map_from_camera;
};

/// Writes the thesis's figures of tracking into `folder`/figures/tracking.exr, all on the undistorted
/// sensor:
///   L, gradient, map             the reference view's log intensity, the magnitude of its gradient
///                                [1/px], and the pixels that became map points (1), fig. 4.2
///   mask, mask_depth             the map drawn into the moment's view: pixels hit (0..1) and their
///                                depth [m], 0 = none, before the blur, fig. 4.4 a and b
///   template, template_depth     the same after it, fig. 4.4 c and d, fig. 4.6 a
///   events                       the event frame (0..1), fig. 4.5, fig. 4.6 b
///   dense, semi_dense, sparse_patches, random
///                                the template points that an iteration of the moment's alignment
///                                uses (1) under each selection, fig. 4.1
/// `camera` with its lens, `map` in the frame of `reference`.
void write_tracking_figures(const std::filesystem::path& folder, const EdgeTrackerOptions& options,
                            const PinholeCamera& camera, const ReferenceView& reference,
                            const MapPoints& map, const TrackingMoment& moment);

}  // namespace saccade
