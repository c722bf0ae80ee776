#include "simulator/replica/resimulation.h"

#include "core/check.h"
#include "simulator/motion/motion.h"
#include "simulator/scene/build_scene.h"
#include "simulator/sensor/event_camera.h"
#include "simulator/sensor/sensor_parameters.h"

namespace saccade {

Resimulation::Resimulation(const SimulationConfig& config)
    : config_(config),
      motion_(cut_motion(build_motion(config.trajectory), config.start_s, config.duration_s)),
      scene_(build_scene(config.scene)) {
  SACCADE_CHECK(config.rig.empty());
}

SensedEvents Resimulation::events(const SensorParameters& sensor) const {
  EventOptions options = config_.events;
  apply(sensor, options);
  SensedEvents all;
  EventCamera camera(scene_, motion_, config_.camera, options, config_.seed);
  camera.record(motion_.end_s(), [&](std::span<const SensedEvent> events, double) {
    all.insert(all.end(), events.begin(), events.end());
  });
  return all;
}

}  // namespace saccade
