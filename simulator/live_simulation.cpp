#include "simulator/live_simulation.h"

#include <span>

#include "core/time_search.h"
#include "simulator/colour_scenes.h"
#include "simulator/motion/motion.h"
#include "simulator/rig.h"
#include "simulator/scene/build_scene.h"

namespace saccade {

LiveSimulation::LiveSimulation(const SimulationConfig& config)
    : config_(config),
      motion_(cut_motion(build_motion(config.trajectory), config.start_s, config.duration_s)),
      scene_(build_scene(config.scene)),
      colours_(build_colour_scenes(config, rig_cameras(config))),
      renderer_(scene_, config_.camera, config.events.samples_per_pixel,
                config.events.texture_filter) {
  restart();
}

void LiveSimulation::restart() {
  source_ = make_event_source(config_.events, config_.seed, scene_, colours_ ? &*colours_ : nullptr,
                              motion_, config_.camera);
  found_.clear();
  taken_ = 0;
}

Events LiveSimulation::take_until(double t_s, const std::function<void()>& between) {
  found_.erase(found_.begin(), found_.begin() + static_cast<std::ptrdiff_t>(taken_));
  taken_ = 0;
  const bool is_end = t_s >= duration_s();
  // What is found up to a time may still come before it by the rounding to ticks.
  const double complete_s = t_s + 3 * seconds_from_ns(config_.events.timestamp_unit_ns());
  while (source_->reached_s() < duration_s() && (is_end || source_->reached_s() < complete_s)) {
    source_->step(duration_s(), [&](std::span<const SensedEvent> events, double) {
      for (const SensedEvent& event : events) found_.push_back(event.event());
    });
    if (between) between();
  }
  taken_ = is_end ? found_.size() : count_before(found_, ns_from_seconds(t_s));
  return {found_.begin(), found_.begin() + static_cast<std::ptrdiff_t>(taken_)};
}

ImageF LiveSimulation::frame(double t_s) const {
  const StampedPose pose{t_s, motion_.pose(t_s)};
  return renderer_.radiance(std::span(&pose, 1));
}

ImageF LiveSimulation::depth(double t_s) const { return renderer_.depth({t_s, motion_.pose(t_s)}); }

FlowField LiveSimulation::flow(double t_s) const { return renderer_.flow(motion_.state(t_s), t_s); }

}  // namespace saccade
