#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/config/fields.h"
#include "eval/sweep/plan/sampled_parameters.h"
#include "eval/sweep/plan/settings.h"

namespace saccade {

/// A simulation configuration that datasets are made from.
struct GenerateScene {
  std::string name;                ///< default: the file without its ending
  std::filesystem::path simulate;  ///< a simulation configuration
  int weight = 1;                  ///< how often it is drawn, compared with the others
  Settings set;                    ///< overrides, after those of all scenes
  SampledParameters draw;                      ///< in place of those of the same key of all scenes
};

/// Many datasets from ranges: each of its own scene, overrides and seed.
struct GenerateConfig {
  std::string name = "dataset";  ///< of the folders: dataset-000417
  std::uint64_t first = 0;       ///< index
  int count = 0;
  std::uint64_t seed = 1;
  std::vector<GenerateScene> scenes;
  Settings set;  ///< overrides of every scene
  SampledParameters draw;
};

void describe(config::Fields& fields, GenerateScene& scene);
void describe(config::Fields& fields, GenerateConfig& generate);

/// One of the datasets.
struct GeneratedDataset {
  std::uint64_t index = 0;
  std::string name;
  const GenerateScene* scene = nullptr;
  std::uint64_t seed = 0;  ///< of its simulation
  Settings settings;       ///< in the order in which they are applied
  /// What was drawn, down to single values: "trajectory.position.0" -> "0.12".
  std::vector<std::pair<std::string, std::string>> drawn;
};

/// A function of the file's seed and the index alone, so that dataset 417 is the same among 500 and
/// among 1000.
[[nodiscard]] GeneratedDataset generated_dataset(const GenerateConfig& generate,
                                                 std::uint64_t index);

}  // namespace saccade
