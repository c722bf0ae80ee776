#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/config/fields.h"
#include "eval/sweep/plan/generate.h"
#include "eval/sweep/plan/settings.h"
#include "eval/sweep/launch/slurm_options.h"

namespace saccade {

/// A dataset folder that exists, or a simulation that makes one for each of its seeds.
struct SweepDataset {
  std::string name;  ///< default: the last part of the folder, or the file without its ending
  std::optional<std::filesystem::path> path;
  std::optional<std::filesystem::path> simulate;  ///< a simulation configuration
  Settings set;                                   ///< on top of it
  std::vector<std::uint64_t> seeds;               ///< of the simulation; empty: the one it states
};

struct SweepConfiguration {
  std::string name;    ///< default: the file without its ending, after the module if it has its own
  std::string module;  ///< default: the sweep's
  std::optional<std::filesystem::path> file;  ///< default: the defaults of the module
  /// In its place the adapter of an external program, which runs instead of the module and is
  /// ranked in its table.
  std::optional<std::filesystem::path> adapter;
  Settings set;
  std::vector<std::string> datasets;  ///< names of those it runs over; empty: all
  std::vector<std::uint64_t> seeds;   ///< empty: the sweep's
  std::optional<int> repeat;          ///< default: the sweep's
  /// Names of configurations before it: its run gets theirs of the same dataset, variant, point of
  /// the grid and seed, as --from, --poses-from and --depth-from. Empty: none.
  std::string from, poses_from, depth_from;

  [[nodiscard]] bool runs_over(const std::string& dataset) const;
};

/// A figure that a benchmark is known to reach, as mean over the seeds (of a speed the median).
struct ExpectedMetric {
  std::string configuration;
  std::vector<std::string> datasets;  ///< empty: all that the configuration runs over
  std::string metric;                 ///< key of metrics.json
  std::optional<double> at_most;
  std::optional<double> at_least;
};

/// A named list of overrides: a row of an ablation.
struct SweepVariant {
  std::string name;
  Settings set;
};

/// The contents of a sweep file: every configuration x variant x point of the grid x seed runs over
/// every dataset. Without configurations the datasets are simulated and nothing else.
struct SweepConfig {
  std::string title;
  std::string module = "track";
  std::vector<SweepDataset> datasets;
  std::optional<GenerateConfig> generate;  ///< in place of datasets; nothing runs over them
  std::vector<SweepConfiguration> configurations;
  std::vector<SweepVariant> variants;
  Grid grid;
  std::vector<std::uint64_t> seeds;  ///< of the runs; empty: the one that the configuration states
  int repeat = 1;                    ///< of each run, for its timing
  bool timing = false;               ///< one run at a time, with one thread
  int threads = 1;                   ///< of one run, or of one dataset that is generated
  bool cache = true;                 ///< simulations go to the cache that all sweeps share
  std::optional<double> start_s;     ///< window of the runs, as --start-s
  std::optional<double> duration_s;
  std::vector<std::string>
      metrics;         ///< columns of sweep.md and its pictures; empty: the usual ones
  SlurmOptions slurm;  ///< for the launcher of that name
  std::vector<ExpectedMetric> expected;

  [[nodiscard]] const std::vector<std::uint64_t>& seeds_of(
      const SweepConfiguration& configuration) const {
    return configuration.seeds.empty() ? seeds : configuration.seeds;
  }
};

void describe(config::Fields& fields, SweepConfig& sweep);

}  // namespace saccade
