#include "simulator/sensor/event_options.h"

namespace saccade {

void describe(config::Fields& fields, EventOptions& options) {
  fields.choice("preset", options.preset,
                {{"ideal", SensorModel::kIdeal},
                 {"davis240c", SensorModel::kDavis240c},
                 {"dvxplorer", SensorModel::kDvxplorer}},
                "Sensor whose thresholds and noise are the defaults of the other keys.");
  if (fields.has("preset")) {
    const SensorPreset preset = sensor_preset(options.preset);
    options.contrast = preset.contrast;
    options.noise = preset.noise;
  }
  fields
      .value(
          "contrast_on", options.contrast.on,
          "Increase of the log intensity that fires an ON event; smaller values give more events.")
      .range(0.001, 10);
  fields
      .value(
          "contrast_off", options.contrast.off,
          "Decrease of the log intensity that fires an OFF event; smaller values give more events.")
      .range(0.001, 10);
  fields
      .value("log_eps", options.log_eps,
             "Offset eps of the log intensity ln(eps + I); larger values make dark surfaces less "
             "sensitive.")
      .range(1e-9, 1);
  fields
      .value("time_tolerance_us", options.time_tolerance_us,
             "Bound of the time error of every event before rounding to the unit, in microseconds; "
             "smaller values cost more evaluations.")
      .range(1e-3, 1000);
  fields
      .value("samples_per_pixel", options.samples_per_pixel,
             "Number of rays whose mean radiance a pixel sees: 1, 4 or 16. Cost grows with it.")
      .range(1, 16);
  fields.expect(options.samples_per_pixel == 1 || options.samples_per_pixel == 4 ||
                    options.samples_per_pixel == 16,
                "samples_per_pixel", "must be 1, 4 or 16");
  fields.choice("timestamp_unit", options.timestamp_unit,
                {{"us", TimestampUnit::kMicroseconds}, {"ns", TimestampUnit::kNanoseconds}},
                "Resolution of the recorded times.");
  fields
      .value("max_step_px", options.max_step_px,
             "Largest image motion between two samples of a pixel, in pixels; smaller values miss "
             "fewer thin objects and trace more rays.")
      .range(0.01, 2);
  fields.choice("sampling", options.sampling,
                {{"asynchronous", Sampling::kAsynchronous}, {"frames", Sampling::kFrames}},
                "How the signal is sampled: every pixel at its own times, or whole frames with "
                "straight lines in between.");
  fields
      .value("frames_lambda_px", options.frames_lambda_px,
             "Largest image motion between two frames where sampling is frames, in pixels; smaller "
             "values are more exact and slower.")
      .range(0.01, 10);
  fields
      .value("frames_rate_hz", options.frames_rate_hz,
             "Fixed number of frames per second where sampling is frames. 0 means that "
             "frames_lambda_px decides.")
      .range(0, 1e6);
  fields.choice("texture_filter", options.texture_filter,
                {{"bilinear", TextureFilter::kBilinear}, {"mipmap", TextureFilter::kMipmap}},
                "Whether a ray sees the point of a texture that it intersects, or the mean over "
                "its footprint.");
  fields.section("noise", options.noise, "Imperfections of the sensor, all off by default.");
}

}  // namespace saccade
