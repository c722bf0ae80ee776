#include "tests/bench/study/scenario.h"

#include "core/config/config.h"
#include "simulator/motion/motion.h"
#include "simulator/scene/build_scene.h"

namespace saccade::study {
namespace {

SimulationConfig read(const std::string& file, std::span<const std::string> overrides) {
  return config::read<SimulationConfig>(
      config::load(file, std::vector<std::string>(overrides.begin(), overrides.end())));
}

}  // namespace

Scenario::Scenario(const std::string& file, std::span<const std::string> overrides)
    : config(read(file, overrides)),
      motion(cut_motion(build_motion(config.trajectory), config.start_s, config.duration_s)),
      scene(build_scene(config.scene)) {}

}  // namespace saccade::study
