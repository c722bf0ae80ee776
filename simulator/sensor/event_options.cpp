#include "simulator/sensor/event_options.h"

namespace saccade {

void describe(config::Fields& fields, EventOptions& options) {
  fields.choice("preset", options.preset,
                {{"ideal", SensorModel::kIdeal},
                 {"davis240c", SensorModel::kDavis240c},
                 {"dvxplorer", SensorModel::kDvxplorer}},
                "sensor whose thresholds and noise are the defaults");
  if (fields.has("preset")) {
    const SensorPreset preset = sensor_preset(options.preset);
    options.contrast = preset.contrast;
    options.noise = preset.noise;
  }
  fields.value("contrast_on", options.contrast.on, "threshold of ON events [log units]")
      .range(0.001, 10);
  fields.value("contrast_off", options.contrast.off, "threshold of OFF events [log units]")
      .range(0.001, 10);
  fields.value("log_eps", options.log_eps, "eps of the log intensity ln(eps + I)").range(1e-9, 1);
  fields
      .value("time_tolerance_us", options.time_tolerance_us,
             "bound of every event's time error, before rounding to the unit [us]")
      .range(1e-3, 1000);
  fields.value("samples_per_pixel", options.samples_per_pixel,
               "rays whose mean radiance a pixel sees: 1, 4 or 16");
  fields.expect(options.samples_per_pixel == 1 || options.samples_per_pixel == 4 ||
                    options.samples_per_pixel == 16,
                "samples_per_pixel", "must be 1, 4 or 16");
  fields.choice("timestamp_unit", options.timestamp_unit,
                {{"us", TimestampUnit::kMicroseconds}, {"ns", TimestampUnit::kNanoseconds}},
                "resolution of the recorded times");
  fields
      .value("max_step_px", options.max_step_px,
             "image motion between two looks at a pixel, over its neighbourhood [px]")
      .range(0.01, 2);
  fields.choice("sampling", options.sampling,
                {{"asynchronous", Sampling::kAsynchronous}, {"frames", Sampling::kFrames}},
                "every pixel at its own times, or whole frames");
  fields
      .value("frames_lambda_px", options.frames_lambda_px,
             "greatest image motion between two frames of sampling: frames [px]")
      .range(0.01, 10);
  fields
      .value("frames_rate_hz", options.frames_rate_hz,
             "frames per second of sampling: frames; 0: as the motion asks for")
      .range(0, 1e6);
  fields.choice("texture_filter", options.texture_filter,
                {{"bilinear", TextureFilter::kBilinear}, {"mipmap", TextureFilter::kMipmap}},
                "the point that a ray meets, or the mean over its footprint");
  fields.section("noise", options.noise, "imperfections of the sensor, all off by default");
}

}  // namespace saccade
