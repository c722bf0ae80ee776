#pragma once

#include <filesystem>
#include <vector>

#include "core/io/dataset/dataset_record.h"
#include "simulator/sensor/rays/ray_tracer.h"
#include "simulator/simulation_config.h"

namespace saccade {

/// What one camera recorded and what it cost.
struct CameraReport {
  DatasetRecord record;  ///< as in its dataset.yaml
  EventStatistics events;
  double images_s = 0;  ///< frames, depth maps and motion fields, with writing
  double events_s = 0;  ///< events, with writing

  [[nodiscard]] std::int64_t event_count() const;
};

/// What a simulation produced and what it cost.
struct SimulationReport {
  std::vector<CameraReport> cameras;  ///< at least the first one, then those of the rig
  double load_s = 0;                  ///< scene and trajectory
  double total_s = 0;                 ///< everything, hashing included
};

/// Simulates `config` into the dataset folder `output` (an existing dataset there is replaced),
/// which appears under its name when it is complete. What a killed program left of the same
/// simulation is resumed. Shows progress. The bytes depend on `config` alone, not on interruptions
/// or the number of threads. Throws InputError for anything wrong with the configuration or the
/// files that it names.
SimulationReport simulate(const SimulationConfig& config, const std::filesystem::path& output);

}  // namespace saccade
