#pragma once

#include <filesystem>
#include <string>

#include "core/io/files/atomic_file.h"
#include "core/io/run/run_record.h"
#include "eval/metrics/metrics.h"
#include "tests/support/command.h"

namespace saccade::testing {

inline constexpr const char* kDrift = "trajectory.drift_percent";

/// What of a run matters to a result store.
struct StoredRun {
  std::string name;
  std::string config = "best";
  std::string dataset = "walls";
  std::string commit = "aaaa11112222";
  std::uint64_t seed = 1;
  Metrics metrics = {};  ///< none: no metrics.json
};

inline Metrics one_metric(const std::string& key, std::optional<double> value) {
  Metrics metrics;
  metrics.set(key, value);
  return metrics;
}

/// Writes run.yaml and metrics.json of a run into a folder of its name. Returns the folder.
inline std::filesystem::path write_stored_run(const std::filesystem::path& parent,
                                              const StoredRun& run) {
  const std::filesystem::path folder = parent / run.name;
  std::filesystem::create_directories(folder);
  RunRecord record;
  record.module = "track";
  record.dataset = "/data/" + run.dataset;
  record.dataset_sha256 = "1234";
  record.window = RunRecord::Window{0, 2};
  record.seed = run.seed;
  record.threads = 1;
  record.tool_version = "0.1.0 (" + run.commit + ")";
  record.command = "saccade run track --data /data/" + run.dataset + " -c configs/" + run.config +
                   ".yaml --set align.samples=50 --set seed=3 -o " + run.name;
  record.machine = "a machine";
  record.config_yaml = "align:\n  samples: 50\n";
  write_run_record(folder / "run.yaml", record);
  if (!run.metrics.empty()) write_atomically(folder / "metrics.json", to_json(run.metrics));
  return folder;
}

}  // namespace saccade::testing
