#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/config/fields.h"
#include "eval/sweep/plan/generate.h"
#include "eval/sweep/plan/halving_config.h"
#include "eval/sweep/plan/settings.h"

namespace saccade {

/// An existing dataset folder, a simulation that makes one dataset per seed, or the events of an
/// external simulator.
struct SweepDataset {
  std::string name;
  std::optional<std::filesystem::path> path;
  bool is_optional = false;  ///< the sweep goes on without it where `path` does not exist
  std::optional<std::filesystem::path> simulate;
  std::optional<std::filesystem::path> adapter;  ///< runs over `against`
  std::string against;  ///< earlier dataset whose events are the truth of these; empty: none
  Settings set;
  std::vector<std::uint64_t> seeds;  ///< empty: the one that the simulation states
};

/// A method with its parameters: a module's configuration file, or an external program's adapter.
struct SweepConfiguration {
  std::string name;
  std::string module;                         ///< empty: the sweep's
  std::optional<std::filesystem::path> file;  ///< nullopt: the module's default values
  std::optional<std::filesystem::path> adapter;
  Settings set;
  std::vector<std::string> datasets;  ///< or scenes of generated ones; empty: all
  int every = 1;                      ///< of generated datasets, those whose index it divides
  std::vector<std::uint64_t> seeds;   ///< empty: the sweep's
  std::optional<int> repeat;          ///< nullopt: the sweep's
  /// Earlier configurations whose run at the same dataset, variant, grid point and seed is passed
  /// as --from, --poses-from and --depth-from. Empty: none.
  std::string from, poses_from, depth_from;

  [[nodiscard]] bool runs_over(const std::string& dataset) const;
};

/// A bound that a metric must keep, as the mean over the seeds (of a speed the median).
struct ExpectedMetric {
  std::string configuration;
  std::vector<std::string> datasets;  ///< empty: all that the configuration runs over
  std::string metric;
  std::optional<double> at_most;
  std::optional<double> at_least;
};

/// Named overrides: one row of an ablation.
struct SweepVariant {
  std::string name;
  Settings set;
};

/// Which points of the grid run.
enum class GridPlan {
  kFactorial,   ///< every combination
  kOneAtATime,  ///< the first values of all keys, and every other value of one key beside them
};

/// A sweep file: every configuration x variant x grid point x seed runs over every dataset. Without
/// configurations the datasets are only simulated.
struct SweepConfig {
  std::string title;
  std::string module = "track";
  std::vector<SweepDataset> datasets;
  std::optional<GenerateConfig> generate;  ///< in place of `datasets`
  std::vector<SweepConfiguration> configurations;
  std::vector<SweepVariant> variants;
  Grid grid;
  GridPlan plan = GridPlan::kFactorial;
  std::optional<HalvingConfig> halving;
  std::string reference;  ///< variant or configuration that the others are tested against; empty:
                          ///< none
  std::vector<std::uint64_t> seeds;  ///< empty: the one that the configuration states
  int repeat = 1;
  bool timing = false;
  int threads = 1;
  std::optional<double> duration_s;
  std::vector<std::string> metrics;  ///< empty: the usual ones
  std::vector<ExpectedMetric> expected;

  /// What configurations and expected metrics name: datasets, or scenes of generated ones.
  [[nodiscard]] std::vector<std::string> dataset_names() const;
  [[nodiscard]] const std::vector<std::uint64_t>& seeds_of(
      const SweepConfiguration& configuration) const {
    return configuration.seeds.empty() ? seeds : configuration.seeds;
  }
};

void describe(config::Fields& fields, SweepConfig& sweep);

/// Removes the optional datasets that do not exist, with the configurations and expected metrics of
/// theirs alone. Returns a sentence for each.
std::vector<std::string> leave_out_absent(SweepConfig& sweep);

}  // namespace saccade
