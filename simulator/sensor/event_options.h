#pragma once

#include <optional>

#include "core/config/fields.h"
#include "core/event.h"
#include "core/io/events/event_file.h"
#include "core/io/sensor_file.h"
#include "simulator/sensor/noise/noise_options.h"
#include "simulator/sensor/pixel/event_pixel.h"

namespace saccade {

/// Sensors whose values are known (key `events.preset`).
enum class SensorModel { kIdeal, kDavis240c, kDavis346, kDvxplorer };

/// What a preset states: the defaults of these keys, which every stated key overrides.
struct SensorPreset {
  Contrast contrast;
  NoiseOptions noise;
};

[[nodiscard]] SensorPreset sensor_preset(SensorModel sensor);

/// How the signal is sampled.
enum class Sampling {
  kExact,     ///< every pixel at its own times, crossings located on the continuous signal
  kAdaptive,  ///< with rays where the signal asks for them, and an exact audit of some pixels
  kAuto,      ///< one of these two, by scene and configuration
  kFrames,    ///< whole frames, linear in between (ESIM; Rebecq et al., CoRL 2018): a baseline
};

/// What a ray sees of a texture.
enum class TextureFilter {
  kBilinear,  ///< the point it intersects
  kMipmap,    ///< the mean over the pixel's footprint
};

/// What is in front of the pixels.
enum class ColourFilter {
  kNone,  ///< every pixel sees the luminance
  kRggb,  ///< Bayer's pattern: red and green in even rows, green and blue in odd ones
};

/// The event sensor (section `events`).
struct EventOptions {
  SensorModel preset = SensorModel::kIdeal;
  Contrast contrast;
  double log_eps = 1e-3;
  double time_tolerance_us = 1;
  int samples_per_pixel = 1;
  TimestampUnit timestamp_unit = TimestampUnit::kMicroseconds;
  double max_step_px = 0.5;
  Sampling sampling = Sampling::kExact;
  double audit_fraction = 0.01;
  double frames_lambda_px = 0.5;
  double frames_rate_hz = 0;
  TextureFilter texture_filter = TextureFilter::kBilinear;
  ColourFilter colour_filter = ColourFilter::kNone;
  NoiseOptions noise;
  /// Side of the square that a pixel sees, in distances to the next pixel. No key: it is less than
  /// 1 where every second pixel of a sensor is simulated.
  double pixel_side = 1;
  /// Of a calibrated sensor: describe() puts them behind the preset's values and before stated keys.
  /// No key: SimulationConfig has the file's.
  std::optional<SensorParameters> sensor;

  [[nodiscard]] TimeNs timestamp_unit_ns() const {
    return timestamp_unit == TimestampUnit::kMicroseconds ? 1000 : 1;
  }
};

void describe(config::Fields& fields, EventOptions& options);

}  // namespace saccade
