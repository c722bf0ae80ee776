#pragma once

#include <span>
#include <string>

#include "simulator/scene/scene.h"
#include "simulator/simulation_config.h"

namespace saccade::study {

/// A configuration that is ready to be recorded from.
struct Scenario {
  SimulationConfig config;
  Spline motion;
  Scene scene;

  /// `overrides`: "key.path=value", as behind --set.
  Scenario(const std::string& file, std::span<const std::string> overrides);
};

}  // namespace saccade::study
