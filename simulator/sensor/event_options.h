#pragma once

#include "core/config/fields.h"
#include "core/event.h"
#include "core/io/event_file.h"
#include "simulator/sensor/pixel/event_pixel.h"
#include "simulator/sensor/noise/noise_options.h"
#include "simulator/sensor/noise/sensor_presets.h"

namespace saccade {

/// How the signal is sampled.
enum class Sampling {
  kAsynchronous,  ///< every pixel at its own times, crossings located on the continuous signal
  kFrames,        ///< whole frames, linear in between (ESIM; Rebecq et al., CoRL 2018): a baseline
};

/// What a ray sees of a texture.
enum class TextureFilter {
  kBilinear,  ///< the point it meets
  kMipmap,    ///< the mean over the pixel's footprint
};

/// The event sensor (section `events`).
struct EventOptions {
  SensorModel preset = SensorModel::kIdeal;  ///< where the defaults of contrast and noise come from
  Contrast contrast;
  double log_eps = 1e-3;         ///< eps of L = ln(eps + I)
  double time_tolerance_us = 1;  ///< width of the final bracket around every crossing
  int samples_per_pixel = 1;     ///< rays whose mean radiance a pixel sees: 1, 4 or 16
  TimestampUnit timestamp_unit = TimestampUnit::kMicroseconds;
  double max_step_px = 0.5;  ///< image motion between two looks at a pixel
  Sampling sampling = Sampling::kAsynchronous;
  double frames_lambda_px = 0.5;  ///< greatest image motion between two frames
  double frames_rate_hz = 0;      ///< frames per second in place of that; 0: by the motion
  TextureFilter texture_filter = TextureFilter::kBilinear;
  NoiseOptions noise;

  [[nodiscard]] TimeNs timestamp_step_ns() const {
    return timestamp_unit == TimestampUnit::kMicroseconds ? 1000 : 1;
  }
};

void describe(config::Fields& fields, EventOptions& options);

}  // namespace saccade
