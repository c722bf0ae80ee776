#include "estimator/reconstruction/reconstruction_config.h"

#include <algorithm>

#include "estimator/reconstruction/contrast_thresholds.h"
#include "estimator/reconstruction/reconstruction_output.h"
#include "estimator/run/sensor_input.h"

namespace saccade {
namespace {

/// A pixel whose threshold is off by sigma is off by as much of the log intensity at each event.
void take_mismatch(const SensorFile& sensor, ReconstructionConfig& config) {
  if (!sensor.events.mismatch_sigma || !config.contrast_on || !config.contrast_off) return;
  const double sigma =
      *sensor.events.mismatch_sigma * (*config.contrast_on + *config.contrast_off) / 2;
  for (ObservationOptions* options :
       {&config.gradient.observations, &config.equations.observations})
    options->event_sigma = std::max(options->event_sigma, sigma);
}

}  // namespace

void describe(config::Fields& fields, ReconstructionConfig& config) {
  if (const auto sensor = describe_sensor(fields, config.sensor)) {
    config.contrast_on = sensor->estimator_contrast_on();
    config.contrast_off = sensor->estimator_contrast_off();
    take_mismatch(*sensor, config);
  }
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
