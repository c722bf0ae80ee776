#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "simulator/sensor/noise/noise_options.h"

namespace saccade {

/// What every part of the sensor behind the pixels is made from.
struct OutputStageInput {
  const NoiseOptions& noise;
  int width, height;
  TimeNs unit_ns;  ///< all times are multiples of it
  std::uint64_t seed;
};

/// One row of the table of models. A model has the hook of the place at which it acts: pixels that
/// differ, or a stage behind them. The models within a pixel that act in time (refractory, shot,
/// bandwidth, hot) have neither: they are parts of PixelNoise, which PixelSensor's one loop asks.
struct NoiseModel {
  std::string_view name;  ///< section of the configuration
  std::string_view help;
  void (*describe)(config::Fields& fields, NoiseOptions& options);
  bool (*is_on)(const NoiseOptions& options);
  /// Changes what a pixel is for its whole life; called when the model is on. nullptr: does not.
  void (*shape_pixel)(const NoiseOptions& options, std::uint64_t seed, PixelTraits& traits);
  /// Makes the stage that the events pass behind the pixels. nullptr: none.
  std::unique_ptr<OutputStage> (*make_stage)(const OutputStageInput& input);
};

/// All models. shape_pixel() is called, and stages are passed and saved, in this order.
[[nodiscard]] std::span<const NoiseModel> noise_models();

}  // namespace saccade
