#pragma once

#include "simulator/sensor/noise/noise_options.h"
#include "simulator/sensor/pixel/event_pixel.h"

namespace saccade {

/// Sensors whose values are known (key `events.preset`).
enum class SensorModel { kIdeal, kDavis240c, kDvxplorer };

/// What a preset states: the defaults of these keys, which every stated key overrides.
struct SensorPreset {
  Contrast contrast;
  NoiseOptions noise;
};

[[nodiscard]] SensorPreset sensor_preset(SensorModel sensor);

}  // namespace saccade
