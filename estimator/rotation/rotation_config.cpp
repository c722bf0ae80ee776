#include "estimator/rotation/rotation_config.h"

namespace saccade {
namespace {

void describe_events(config::Fields& fields, RotationOptions& options) {
  fields.value("events", options.events, "per window").range(100, 1e8);
  fields.value("min_events", options.min_events, "a window with fewer says nothing").range(10, 1e8);
  fields.value("max_window_s", options.max_window_s, "a slow window is cut here").range(1e-4, 10);
  fields.value("samples", options.samples, "at most so many events of a window are used")
      .range(100, 1e8);
  fields.value("blur_px", options.blur_px, "of the image of events").range(0.1, 20);
  fields
      .value("burst_share", options.burst_share,
             "events of a pixel and polarity that follow one another within this share of the "
             "window's length are one edge; only the first is used")
      .range(0, 1);
  fields.value("iterations", options.iterations, "of quasi-Newton steps, at most").range(1, 1000);
  fields
      .value("tolerance_px", options.tolerance_px,
             "a step that moves events by less on the average is the last")
      .range(1e-6, 10);
}

}  // namespace

void describe(config::Fields& fields, RotationConfig& config) {
  using Source = RotationConfig::Source;
  fields.choice("source", config.source,
                {{"events", Source::kEvents}, {"imu", Source::kImu}, {"both", Source::kBoth}},
                "where the angular velocity comes from");
  if (config.source != Source::kImu)
    fields.group(
        "events", [&](config::Fields& f) { describe_events(f, config.events); },
        "contrast of the turned events");
  if (config.source == Source::kImu) {
    fields.group(
        "orientation", [&](config::Fields& f) { describe(f, config.orientation); },
        "filter that finds the gyroscope's bias");
    fields.value("average_s", config.average_s, "mean over so long; 0 for every reading")
        .range(0, 10);
  }
  if (config.source == Source::kBoth) {
    fields.group(
        "gyroscope", [&](config::Fields& f) { describe(f, config.fusion.gyroscope); }, "its noise");
    fields
        .value("events_sigma_px", config.fusion.events_sigma_px,
               "error of the events at the start, as they would be moved by it; learned from then "
               "on")
        .range(1e-4, 100);
  }
  fields.value("seed", config.seed, "of random numbers; none are drawn");
}

}  // namespace saccade
