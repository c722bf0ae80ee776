#include "estimator/reconstruction/reconstruction_config.h"

#include "estimator/reconstruction/contrast_thresholds.h"
#include "estimator/reconstruction/reconstruction_output.h"

namespace saccade {

void describe(config::Fields& fields, ReconstructionConfig& config) {
  describe(fields, config, true);
  fields.section("depth", config.depth, "Propagation of the known depth to the poses of events.");
  describe_contrast(fields, config.contrast_on, config.contrast_off);
  fields.group(
      "window", [&](config::Fields& f) { describe(f, config.window); },
      "Part of the events from which one view is reconstructed.");
  describe_snapshots(fields, config.snapshot_events);
  fields.value("figures", config.figures,
               "Whether to write the data of the thesis's figures 6.1 (Poisson's equation) and 6.2 "
               "(depth propagation), computed from the truth, to figures/.");
  fields.value("seed", config.seed, "Without effect: this module draws no random numbers.");
}

std::unique_ptr<ImageEstimator> make_image_estimator(const ReconstructionConfig& config,
                                                     const PinholeCamera& camera) {
  return std::make_unique<ImageEstimator>(camera, config.observations(), make_image_solver(config));
}

}  // namespace saccade
