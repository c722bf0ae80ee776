#include "estimator/rotation/rotation_config.h"

namespace saccade {

void describe(config::Fields& fields, RotationConfig& config) {
  using Source = RotationConfig::Source;
  fields.choice("source", config.source,
                {{"events", Source::kEvents}, {"imu", Source::kImu}, {"both", Source::kBoth}},
                "Source of the angular velocity: contrast maximisation over the events "
                "(`events`), the gyroscope less its estimated bias (`imu`), or the fusion of "
                "both by their variances (`both`).");
  if (config.source != Source::kImu) {
    fields
        .value("window_events", config.events.window_events,
               "Number of events per window, about two per pixel of the sensor. Larger windows "
               "average more noise, but the rotation may change too much within them.")
        .range(100, 1e8);
    fields
        .value("max_window_s", config.events.max_window_s,
               "Longest window, in seconds. Slow motion is cut here and gets windows with fewer "
               "events.")
        .range(1e-4, 10);
  }
  if (config.source == Source::kImu) {
    fields.section("orientation", config.orientation,
                   "Orientation filter that estimates the bias of the gyroscope.");
    fields
        .value("averaging_s", config.averaging_s,
               "Time over which the angular velocity is averaged, in seconds. 0 writes every "
               "sample.")
        .range(0, 10);
  }
  if (config.source == Source::kBoth)
    fields.section("gyroscope", config.gyroscope, "Noise of the gyroscope.");
  fields.value("seed", config.seed,
               "Seed of the run. It changes nothing here: no random numbers are drawn.");
}

}  // namespace saccade
