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

/// What makes two runs a pair: the same work, by whichever build.
struct GateKey {
  std::string dataset;  ///< name of its folder
  std::string module;   ///< "track", "depth", ...
  std::string config;   ///< name of the configuration's file and what was --set; empty: any
  std::uint64_t seed = 0;

  [[nodiscard]] auto operator<=>(const GateKey&) const = default;
  /// "walls, track accurate", whatever the seed.
  [[nodiscard]] std::string sequence() const;
  /// The same with the seed.
  [[nodiscard]] std::string text() const;
};

/// A scored run as far as the gate knows it.
struct GateRun {
  GateKey key;
  std::string machine;  ///< kind: the processor and the system, without the system's version
  int threads = 0;
  std::string tool_version;
  /// Scores by dotted key, sorted; nullopt where null. Of the speed wall_s.*, events, repetitions.
  std::map<std::string, std::optional<double>> metrics;

  /// The number at `metric`; nullopt where it is null or absent.
  [[nodiscard]] std::optional<double> get(const std::string& metric) const;
};

/// A run by its record and its scores.
[[nodiscard]] GateRun gate_run(const RunRecord& record, const Metrics& metrics);

/// Reads run.yaml and metrics.json. Throws InputError for a folder that is no run, or one that has
/// not been scored.
[[nodiscard]] GateRun read_gate_run(const std::filesystem::path& folder);

/// The same for several. InputError where two have one key.
[[nodiscard]] std::vector<GateRun> read_gate_runs(
    const std::vector<std::filesystem::path>& folders);

}  // namespace saccade
