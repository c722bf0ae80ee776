#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "eval/sweep/plan/sweep_config.h"

namespace saccade {

/// Where a job stands in the sweep; what its row of the table begins with.
struct SweepPoint {
  std::string dataset;
  std::optional<std::uint64_t> dataset_seed;
  std::string module;             ///< empty: a simulation
  std::string configuration;      ///< empty: a simulation
  std::string variant;            ///< empty: the sweep has none
  std::vector<std::string> grid;  ///< a value for each axis; empty: a simulation
  std::optional<std::uint64_t> seed;

  /// The same but for the seeds: what is averaged over.
  [[nodiscard]] bool differs_in_seed_only(const SweepPoint& other) const;
};

/// One dataset or run to be made, by one or more calls of `saccade`.
struct SweepJob {
  std::string name;  ///< of its folders: readable and unique in the sweep
  SweepPoint point;
  std::filesystem::path output;                    ///< dataset or run folder
  std::filesystem::path config;                    ///< the file it reads; empty: none
  std::filesystem::path dataset;                   ///< that it reads; empty: it is a simulation
  std::optional<std::size_t> made_by;              ///< the simulation that makes this dataset
  std::vector<std::size_t> sources;                ///< runs before it whose results it reads
  std::vector<std::filesystem::path> source_runs;  ///< their folders
  int stage = 0;  ///< 0: reads no other run; else one after the last of its sources
  std::vector<std::vector<std::string>> commands;  ///< arguments of `saccade`, in turn
  /// The arguments without the paths: with the contents of the files, all that the result depends
  /// on.
  std::string settings;

  [[nodiscard]] bool is_simulation() const { return dataset.empty(); }
  /// The file that a complete output holds.
  [[nodiscard]] const char* marker() const { return is_simulation() ? "dataset.yaml" : "run.yaml"; }
};

/// A sweep taken apart into jobs. Runs come in the order of datasets, configurations, variants,
/// grid (the last key changes fastest) and seeds.
struct SweepPlan {
  std::vector<std::string> axes;  ///< keys of the grid
  std::vector<SweepJob> simulations;
  std::vector<SweepJob> runs;

  [[nodiscard]] int stages() const;

  /// What the table is about: the runs, or the datasets where nothing runs.
  [[nodiscard]] const std::vector<SweepJob>& rows() const {
    return runs.empty() ? simulations : runs;
  }
};

/// `folder`: of the whole sweep; datasets go to folder/data/NAME, runs to folder/runs/NAME.
[[nodiscard]] SweepPlan plan_sweep(const SweepConfig& sweep, const std::filesystem::path& folder);

}  // namespace saccade
