#pragma once

#include <filesystem>

#include "core/camera.h"
#include "core/io/sensor_file.h"
#include "core/spline/spline.h"
#include "simulator/scene/scene.h"
#include "simulator/sensor/pixel/sensed_event.h"
#include "simulator/simulation_config.h"

namespace saccade {

/// One scene and motion seen by many sensors, in memory: what a calibration varies.
class Resimulation {
 public:
  /// `config`: without a rig; its `events` are the sensor where parameters leave it open.
  explicit Resimulation(const SimulationConfig& config);

  /// The events, times from 0, of the same order and bytes as those of `saccade simulate`.
  [[nodiscard]] SensedEvents events(const SensorParameters& sensor) const;
  [[nodiscard]] double duration_s() const { return motion_.end_s(); }

 private:
  SimulationConfig config_;
  Spline motion_;
  Scene scene_;
};

}  // namespace saccade
