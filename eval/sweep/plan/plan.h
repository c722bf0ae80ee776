#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "eval/sweep/plan/sweep_config.h"

namespace saccade {

/// The coordinates of a job in the sweep: the leading cells of its table row.
struct SweepPoint {
  std::string dataset;  ///< of runs over generated datasets, their scene
  std::optional<std::uint64_t> dataset_seed;
  std::string module;             ///< empty: a simulation
  std::string configuration;      ///< empty: a simulation
  std::string variant;            ///< empty: the sweep has none
  std::vector<std::string> grid;  ///< a value for each axis; empty: a simulation
  std::optional<std::uint64_t> seed;
  bool is_generated = false;  ///< then results are summarised by medians and quartiles

  /// Whether both differ at most in their seeds, over which results are averaged.
  [[nodiscard]] bool differs_in_seed_only(const SweepPoint& other) const;
};

/// What became of a job in this call.
enum class JobState {
  kPending,
  kDone,
  kSkipped,
  kFailed,
  kHeld,  ///< waits for what others give, or was given up (Halving)
};

/// One dataset or run, made by one or more commands of `saccade`.
struct SweepJob {
  std::string name;  ///< of its folders; readable, and unique in the sweep
  SweepPoint point;
  std::filesystem::path output;                    ///< dataset or run folder
  std::filesystem::path config;                    ///< configuration file; empty: none
  std::filesystem::path dataset;                   ///< input, or truth of the events; empty: none
  std::optional<std::size_t> made_by;              ///< index of the simulation that makes `dataset`
  std::vector<std::size_t> sources;                ///< indices of the runs whose results it reads
  std::vector<std::filesystem::path> source_runs;  ///< folders of `sources`
  int stage = 0;  ///< 0: reads the result of no other job of its list; else 1 + their largest
  std::vector<std::vector<std::string>> commands;  ///< arguments of `saccade`, run in order
  /// The arguments without the paths. The result depends on these and the contents of the files.
  std::string settings;
  std::filesystem::path scores;  ///< metrics.json; empty: nothing is scored
  bool makes_run = false;        ///< a run folder, not a dataset
  JobState state = JobState::kPending;
  std::string failure;  ///< of kFailed: "refused: ..." for bad input, else "failed: ..."

  /// The file that marks a complete output folder.
  [[nodiscard]] const char* marker() const { return makes_run ? "run.yaml" : "dataset.yaml"; }
};

/// The jobs of a sweep. Runs are ordered by dataset, configuration, variant, grid point (the last
/// key changes fastest) and seed.
struct SweepPlan {
  std::vector<std::string> axes;  ///< keys of the grid
  std::vector<SweepJob> simulations;
  std::vector<SweepJob> runs;

  [[nodiscard]] static int stages(const std::vector<SweepJob>& jobs);

  /// The jobs that have table rows: the runs, or the datasets where nothing runs.
  [[nodiscard]] const std::vector<SweepJob>& rows() const {
    return runs.empty() ? simulations : runs;
  }
};

/// `folder`: that of the sweep; datasets go to folder/data/NAME, runs to folder/runs/NAME.
[[nodiscard]] SweepPlan plan_sweep(const SweepConfig& sweep, const std::filesystem::path& folder);

}  // namespace saccade
