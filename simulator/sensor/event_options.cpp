#include "simulator/sensor/event_options.h"

#include "core/check.h"
#include "simulator/sensor/sensor_parameters.h"

namespace saccade {
namespace {

// Where no source is named the value is an estimate. "Fitted": by `saccade calibrate` to recordings
// (docs/realism.md).
SensorPreset davis240c() {
  SensorPreset preset;
  NoiseOptions& noise = preset.noise;
  preset.contrast = {0.45, 0.34};     // fitted, with a dark current of 2 % of the frame's white
  noise.mismatch.sigma = 0.09;        // 3.5 % contrast (Brandli et al. 2014) over the thresholds
  noise.refractory.period_us = 1500;  // fitted: 1250; floors of gaps: 1500 to 2400
  noise.leak.rate_hz = 0.01;          // counted: 0 to 0.04 before what does not change
  noise.leak.sigma = 0.2;             // v2e: 0.1 decades between pixels
  noise.shot.rate_hz = 0.05;         // counted: 0.02 to 0.1 in bright rooms; v2e's noisy setting: 5
  noise.bandwidth.cutoff_hz = 3000;  // some kHz in bright light (Lichtsteiner et al. 2008)
  noise.bandwidth.order = 2;         // photoreceptor and source follower
  noise.hot.fraction = 5e-4;         // counted: 22 of 43,200 pixels in three seconds
  noise.hot.rate_hz = 5.5;           // their geometric mean
  noise.hot.sigma = 0.7;
  noise.latency.mean_us = 3;  // the least latency (Brandli et al. 2014)
  noise.latency.jitter_us = 1;
  noise.readout.rate_hz = 12e6;        // Brandli et al. 2014
  noise.readout.rows = true;           // a row's request, then its columns
  noise.readout.capacity = 240 * 180;  // every pixel holds its own request
  return preset;
}

SensorPreset davis346() {
  SensorPreset preset = davis240c();  // the same pixel but for what follows
  NoiseOptions& noise = preset.noise;
  preset.contrast = {0.134, 0.255};  // ln 1.143 and -ln(1 - 0.225): half of the pixels respond to
                                     // 14.3 % ON and 22.5 % OFF (data sheet)
  noise.mismatch.sigma = 0.18;       // 3.5 % contrast, as of the DAVIS240C, over their mean
  noise.refractory.period_us = 550;  // floor of the gaps of a camera at rest: 350 to 810
  noise.leak.rate_hz = 0.005;        // counted before a still scene
  noise.shot.rate_hz = 0.003;        // likewise
  noise.hot.fraction = 1e-5;         // none of 89,960 pixels in 0.17 s
  noise.hot.rate_hz = 100;
  noise.hot.sigma = 0.5;
  noise.readout.capacity = 346 * 260;
  return preset;
}

SensorPreset dvxplorer() {
  SensorPreset preset;
  NoiseOptions& noise = preset.noise;
  preset.contrast = {0.122, 0.122};  // ln 1.13: half of the pixels respond (data sheet)
  noise.mismatch.sigma = 0.22;       // all respond at 27.5 %: 4.5 sigma of 307 200 pixels
  noise.refractory.period_us = 390;  // floor of the gaps of a camera at rest: 391 to 395
  noise.leak.rate_hz = 0.007;        // counted before a still scene: 0.004 to 0.011
  noise.leak.sigma = 0.2;
  noise.shot.rate_hz = 0.045;        // likewise: 0.041 to 0.049
  noise.bandwidth.cutoff_hz = 1000;  // latency below 1 ms (data sheet)
  noise.bandwidth.order = 1;
  noise.hot.fraction = 1e-3;  // counted: 73 of 76,800 pixels of a camera at rest
  noise.hot.rate_hz = 58;     // their geometric mean
  noise.hot.sigma = 1;        // their logarithms: 1.3, more than the model takes
  noise.latency.mean_us = 50;
  noise.latency.jitter_us = 20;
  noise.readout.rate_hz = 165e6;  // data sheet
  noise.readout.rows = true;      // groups of pixels (Suh et al., ISCAS 2020), by column
  noise.readout.capacity = 640 * 480;
  return preset;
}

}  // namespace

SensorPreset sensor_preset(SensorModel sensor) {
  switch (sensor) {
    case SensorModel::kIdeal:
      return {};
    case SensorModel::kDavis240c:
      return davis240c();
    case SensorModel::kDavis346:
      return davis346();
    case SensorModel::kDvxplorer:
      return dvxplorer();
  }
  SACCADE_CHECK(false);
}

void describe(config::Fields& fields, EventOptions& options) {
  fields.choice("preset", options.preset,
                {{"ideal", SensorModel::kIdeal},
                 {"davis240c", SensorModel::kDavis240c},
                 {"davis346", SensorModel::kDavis346},
                 {"dvxplorer", SensorModel::kDvxplorer}},
                "Sensor whose thresholds and noise are the defaults of the other keys.");
  if (fields.has("preset")) {
    const SensorPreset preset = sensor_preset(options.preset);
    options.contrast = preset.contrast;
    options.noise = preset.noise;
  }
  if (fields.reading() && options.sensor) {
    apply(*options.sensor, options);
    options.sensor.reset();  // the cameras of a rig start from the result
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
             "smaller values cost more evaluations. With sampling: frames it bounds nothing: there "
             "the frames decide.")
      .range(1e-3, 1000);
  fields
      .value(
          "samples_per_pixel", options.samples_per_pixel,
          "Number of rays whose mean radiance a pixel sees: 1, 4 or 16, no other. Cost grows with "
          "it.")
      .range(1, 16);
  fields.expect(options.samples_per_pixel == 1 || options.samples_per_pixel == 4 ||
                    options.samples_per_pixel == 16,
                "samples_per_pixel", "must be 1, 4 or 16");
  fields.choice("timestamp_unit", options.timestamp_unit,
                {{"us", TimestampUnit::kMicroseconds}, {"ns", TimestampUnit::kNanoseconds}},
                "Resolution of the recorded times.");
  fields
      .value("max_step_px", options.max_step_px,
             "Largest image motion between two samples of a pixel, in pixels: twice as much where "
             "one triangle fills the surroundings, half as much where surfaces occlude each other "
             "unpredictably. Smaller values miss fewer thin objects and trace more rays.")
      .range(0.01, 2);
  fields.choice(
      "sampling", options.sampling,
      {{"exact", Sampling::kExact},
       {"asynchronous", Sampling::kExact},
       {"adaptive", Sampling::kAdaptive},
       {"auto", Sampling::kAuto},
       {"frames", Sampling::kFrames}},
      "How the signal is sampled: exact finds every crossing (asynchronous is another "
      "name for it); adaptive samples with rays, faster in lit and dense scenes, and "
      "measures its own error; auto takes adaptive for animated meshes and for lit scenes of "
      "many triangles, and exact for all others; frames renders whole frames with straight lines "
      "in between.");
  fields
      .value(
          "audit_fraction", options.audit_fraction,
          "Fraction of the pixels that are recorded exactly, too, where sampling is adaptive, to "
          "measure precision, recall and time error. 0 disables the audit; larger values cost "
          "more and narrow the intervals.")
      .range(0, 1);
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
  fields.choice("colour_filter", options.colour_filter,
                {{"none", ColourFilter::kNone}, {"rggb", ColourFilter::kRggb}},
                "Colour filter before the pixels. rggb is Bayer's pattern with red in the top left "
                "corner: each pixel sees the red, green or blue light of the scene alone. It takes "
                "three more copies of the scene in memory.");
  fields.section("noise", options.noise, "Imperfections of the sensor, all off by default.");
}

}  // namespace saccade
