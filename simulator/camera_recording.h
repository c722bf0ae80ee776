#pragma once

#include "core/io/dataset/dataset_writer.h"
#include "core/spline/spline.h"
#include "simulator/event_log.h"
#include "simulator/scene/scene.h"
#include "simulator/sensor/bayer/bayer_pattern.h"
#include "simulator/simulation_config.h"

namespace saccade {

/// One camera's recording in the making: what the camera moves through and where it is written.
struct CameraRecording {
  const SimulationConfig& config;
  const PinholeCamera& camera;
  const EventOptions& events;
  std::uint64_t seed;  ///< of this camera's random numbers
  const Scene& scene;
  const Spline& world_from_camera;  ///< time 0 is the recording's start
  DatasetWriter& writer;
  EventLog& log;
  const ColourScenes* colours = nullptr;  ///< where events or frames have colours

  [[nodiscard]] double duration_s() const { return world_from_camera.end_s(); }
  [[nodiscard]] StampedPose pose(double t_s) const { return {t_s, world_from_camera.pose(t_s)}; }
};

}  // namespace saccade
