#pragma once

#include <compare>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/io/run/run_record.h"
#include "eval/metrics/metrics.h"

namespace saccade {

/// Identifies the work of a run. Runs of two builds with equal keys are compared.
struct GateKey {
  std::string dataset;  ///< name of its folder
  std::string module;   ///< "track", "depth", ...
  std::string config;   ///< name of the configuration file and the overrides of --set; empty: any
  std::uint64_t seed = 0;

  [[nodiscard]] auto operator<=>(const GateKey&) const = default;
  /// "walls, track accurate": the key without the seed.
  [[nodiscard]] std::string sequence() const;
  /// The same with the seed.
  [[nodiscard]] std::string text() const;
};

/// A scored run: its key, its machine and its metrics.
struct GateRun {
  GateKey key;
  std::string machine;  ///< processor and operating system, without the kernel's version
  int threads = 0;
  std::string tool_version;
  /// Metrics by dotted key; nullopt where null. Of speed.* only wall_s.*, events and repetitions.
  std::map<std::string, std::optional<double>> metrics;

  /// The number at `metric`; nullopt where it is null or absent.
  [[nodiscard]] std::optional<double> get(const std::string& metric) const;
};

/// A run from its record and its metrics.
[[nodiscard]] GateRun gate_run(const RunRecord& record, const Metrics& metrics);

/// Reads run.yaml and metrics.json. Throws InputError for a folder that is no run, or one that has
/// not been scored.
[[nodiscard]] GateRun read_gate_run(const std::filesystem::path& folder);

/// Reads several runs. Throws InputError where two have the same key.
[[nodiscard]] std::vector<GateRun> read_gate_runs(
    const std::vector<std::filesystem::path>& folders);

}  // namespace saccade
