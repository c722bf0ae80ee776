#pragma once

#include <compare>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
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

/// The times of a run on another kind of machine.
struct MachineTimes {
  std::string machine;
  int threads = 0;
  std::map<std::string, std::optional<double>> metrics;  ///< the speed.* of GateRun::metrics
};

/// A scored run: its key, its machine and its metrics.
struct GateRun {
  GateKey key;
  std::string machine;  ///< processor and operating system, without the kernel's version
  int threads = 0;
  std::string tool_version;
  /// Metrics by dotted key; nullopt where null. Of speed.* only wall_s.*, events and repetitions.
  std::map<std::string, std::optional<double>> metrics;
  std::vector<MachineTimes> elsewhere = {};  ///< in a baseline that several machines have updated

  /// The number at `metric`; nullopt where it is null or absent.
  [[nodiscard]] std::optional<double> get(const std::string& metric) const;
};

/// A run from its record and its metrics.
[[nodiscard]] GateRun gate_run(const RunRecord& record, const Metrics& metrics);

/// Replaces the times of each run of a baseline by those that it has of the machine and the number of
/// threads of its partner among `runs`, where it has any; its own then stand among `elsewhere`.
void take_times_of_same_machine(std::vector<GateRun>& baseline, std::span<const GateRun> runs);

/// Keeps the times that `old`, with the same key, has of other kinds of machines.
void keep_times_of_other_machines(GateRun& run, const GateRun& old);

/// Leaves settings that are compared out of the keys, so that runs which differ in them alone are
/// paired: "align.samples" (also those below it, "align"), and "config" the name of the file of -c.
/// Throws InputError (`--compare`) for a key that no run of either side was set, with the nearest
/// one that was, and where two runs of a side are then the same.
void leave_out_compared(std::vector<GateRun>& baseline, std::vector<GateRun>& runs,
                        const std::vector<std::string>& compared);

/// Reads run.yaml and metrics.json. Throws InputError for a folder that is no run, or one that has
/// not been scored.
[[nodiscard]] GateRun read_gate_run(const std::filesystem::path& folder);

/// Reads several runs. Throws InputError where two have the same key.
[[nodiscard]] std::vector<GateRun> read_gate_runs(
    const std::vector<std::filesystem::path>& folders);

}  // namespace saccade
