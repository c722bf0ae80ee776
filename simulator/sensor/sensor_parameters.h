#pragma once

#include "core/io/sensor_file.h"
#include "simulator/sensor/event_options.h"

namespace saccade {

/// Sets the options that `parameters` knows; the others stay.
void apply(const SensorParameters& parameters, EventOptions& options);

/// All of what `options` states in terms of a sensor's parameters.
[[nodiscard]] SensorParameters parameters_of(const EventOptions& options);

}  // namespace saccade
