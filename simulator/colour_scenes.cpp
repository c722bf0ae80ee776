#include "simulator/colour_scenes.h"

#include <algorithm>

#include "simulator/scene/build_scene.h"

namespace saccade {

std::optional<ColourScenes> build_colour_scenes(const SimulationConfig& config,
                                                std::span<const RigCamera> cameras) {
  const bool has_filter = std::ranges::any_of(cameras, [](const RigCamera& camera) {
    return camera.events.colour_filter != ColourFilter::kNone;
  });
  if (!has_filter && config.frames.colour == FrameOptions::Colour::kGrey) return std::nullopt;
  return ColourScenes{build_scene(config.scene, ColourChannel::kRed),
                      build_scene(config.scene, ColourChannel::kGreen),
                      build_scene(config.scene, ColourChannel::kBlue)};
}

}  // namespace saccade
