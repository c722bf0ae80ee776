#pragma once

#include <span>

#include "core/camera.h"
#include "core/event.h"
#include "core/panorama.h"
#include "core/trajectory.h"
#include "estimator/reconstruction/contrast_thresholds.h"
#include "estimator/reconstruction/image_methods.h"

namespace saccade {

/// The methods of reconstruction with the defaults of a panorama: a pixel of it is observed more often
/// than one of a view, so that fewer and larger observations suffice.
struct MosaicOptions : ImageMethodOptions {
  MosaicOptions() {
    method = kEquations;
    gradient.observations.no_event_spacing_px = 3;
    gradient.boundary = Boundary::kNeumann;
    equations.observations.no_event_spacing_px = 0.8;
    equations.observations.dense_events_per_px = 1e9;
    // A camera that turns fast sees other texture after a blind time than before it.
    equations.observations.blind_time_us = 0;
    // To remove it hardly changes a panorama (SSIM by 0.002) but makes its scale worse by 0.03.
    equations.observations.remove_bias = false;
    equations.merge_radius_px = 1.1;
    equations.bound_sigma = 0.2;
    // Each place is seen hundreds of times: noise counts for more than steep edges.
    equations.first_smoothness = 1;
  }
};

/// The input of a mosaic.
struct MosaicInput {
  const PinholeCamera& camera;
  std::span<const Event> events;        ///< in order of time, within that of the orientations
  const Trajectory& world_from_camera;  ///< orientations
  ContrastThresholds thresholds;
};

/// The log intensity that a rotating camera observes, in all directions of the panorama: the rotation
/// camera (thesis 3.4.1). It is image reconstruction with directions in place of reprojections by
/// depth. Few events give a poor image, never an error.
[[nodiscard]] inline Reconstruction make_mosaic(const MosaicInput& input, const Panorama& panorama,
                                                const MosaicOptions& options,
                                                const ProgressCallback& progress = {}) {
  const ReferenceGrid grid(panorama);
  PanoramaObservations source(input.camera, panorama, input.thresholds, options.observations());
  return make_image_solver(options)->solve(source, input.events, input.world_from_camera, grid,
                                           progress);
}

}  // namespace saccade
