#pragma once

#include <optional>
#include <span>

#include "simulator/rig.h"
#include "simulator/sensor/bayer/bayer_pattern.h"
#include "simulator/simulation_config.h"

namespace saccade {

/// The scene in three colours, where the frames or one of the cameras ask for them.
[[nodiscard]] std::optional<ColourScenes> build_colour_scenes(const SimulationConfig& config,
                                                              std::span<const RigCamera> cameras);

}  // namespace saccade
