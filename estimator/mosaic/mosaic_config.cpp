#include "estimator/mosaic/mosaic_config.h"

#include "estimator/reconstruction/contrast_thresholds.h"
#include "estimator/reconstruction/reconstruction_output.h"

namespace saccade {

void describe(config::Fields& fields, MosaicConfig& config) {
  using Extent = MosaicConfig::Extent;
  fields.section("orientation", config.orientation,
                 "Orientation of the camera from the inertial sensor; not used with --poses-from.");
  fields.value(
      "estimate_rate_offset", config.estimate_rate_offset,
      "Whether a constant error of the angular velocity, which a gyroscope's bias leaves, is "
      "estimated by contrast maximisation and removed.");
  fields
      .value("panorama_px_per_rad", config.panorama_px_per_rad,
             "Least resolution of the panorama, in pixels per radian; ~ takes the camera's focal "
             "length. Time and memory grow with its square.")
      .range(1, 10000);
  fields.choice(
      "extent", config.extent, {{"swept", Extent::kSwept}, {"sphere", Extent::kSphere}},
      "Directions of the panorama: swept covers what the camera saw, sphere all of them.");
  describe_contrast(fields, config.contrast_on, config.contrast_off);
  describe(fields, config.mosaic, false);
  describe_snapshots(fields, config.snapshot_events);
  fields.value("seed", config.seed, "Seed of random numbers; none are drawn.");
}

}  // namespace saccade
