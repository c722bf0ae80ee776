#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/config/fields.h"
#include "eval/sweep/plan/sampled_parameters.h"
#include "eval/sweep/plan/settings.h"

namespace saccade {

/// The parts of generated datasets, by their relative sizes.
struct GenerateSplit {
  int train = 1;
  int val = 0;
  int test = 0;
};

/// One of the simulation configurations that datasets are made from.
struct GenerateScene {
  std::string name;                ///< default: the file without its ending
  std::filesystem::path simulate;  ///< a simulation configuration
  int weight = 1;                  ///< relative probability
  std::string split = "any";       ///< train, val or test: all of its datasets belong to it
  Settings set;                    ///< overrides, applied after those of all scenes
  SampledParameters draw;          ///< replace those of all scenes that have the same key
};

/// Overrides and distributions that belong together, such as a motion and the camera that it suits.
struct GenerateCase {
  std::string name;        ///< in the manifest
  int weight = 1;          ///< relative probability
  Settings set;            ///< overrides, applied after those of all scenes
  SampledParameters draw;  ///< replace those of all scenes that have the same key
};

/// Many datasets with sampled parameters; each has its own scene, overrides and seed.
struct GenerateConfig {
  std::string name = "dataset";  ///< before the index in the folder name: dataset-000417
  std::uint64_t first = 0;       ///< index of the first dataset
  int count = 0;
  std::uint64_t seed = 1;
  GenerateSplit split;
  std::optional<double> disk_gb;     ///< space for all datasets; nullopt: not limited
  int shards = 1;                    ///< folders that the datasets are divided among
  std::vector<std::string> classes;  ///< of all scenes; empty: as they state them
  std::vector<GenerateScene> scenes;
  bool scenes_in_turn = false;      ///< dataset k shows scene k modulo their number
  bool paired = false;              ///< in turn, and each sample is shown in all scenes
  std::vector<GenerateCase> cases;  ///< each dataset samples one of them, too; empty: none
  Settings set;                     ///< overrides of every scene
  SampledParameters draw;
};

void describe(config::Fields& fields, GenerateSplit& split);
void describe(config::Fields& fields, GenerateScene& scene);
void describe(config::Fields& fields, GenerateCase& part);
void describe(config::Fields& fields, GenerateConfig& generate);

/// The sampled parameters of one dataset.
struct GeneratedDataset {
  std::uint64_t index = 0;
  std::string name;
  const GenerateScene* scene = nullptr;
  const GenerateCase* part = nullptr;  ///< nullptr: there are no cases
  std::uint64_t seed = 0;              ///< of its simulation
  std::string split;                   ///< train, val or test
  int shard = 0;
  Settings settings;  ///< in the order in which they are applied
  /// The sampled values by path: "trajectory.position.0" -> "0.12".
  std::vector<std::pair<std::string, std::string>> sampled;
};

/// Depends on the file's seed and the index alone: dataset 417 is the same among 500 datasets and
/// among 1000.
[[nodiscard]] GeneratedDataset generated_dataset(const GenerateConfig& generate,
                                                 std::uint64_t index);

}  // namespace saccade
