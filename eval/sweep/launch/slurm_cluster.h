#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "eval/sweep/launch/slurm_queue.h"

namespace saccade {

/// A cluster that runs job arrays, which are identified by their names.
class SlurmCluster {
 public:
  SlurmCluster() = default;
  virtual ~SlurmCluster() = default;
  SlurmCluster(const SlurmCluster&) = delete;
  SlurmCluster& operator=(const SlurmCluster&) = delete;

  /// Throws InputError when the cluster cannot be reached.
  virtual void check() = 0;
  /// The largest number of tasks of an array.
  [[nodiscard]] virtual int max_array_size() = 0;
  /// Submits a script with options of sbatch. Returns why it was rejected; empty when it was
  /// accepted.
  [[nodiscard]] virtual std::string submit(const std::filesystem::path& script,
                                           const std::vector<std::string>& options) = 0;
  /// The states of the tasks of these arrays; nullopt when Slurm does not answer.
  [[nodiscard]] virtual std::optional<SlurmQueue> queue(const std::vector<std::string>& arrays) = 0;
  virtual void cancel(const std::vector<std::string>& arrays) = 0;
};

/// The cluster of the programs sbatch, squeue, scancel and scontrol on the search path.
class SlurmCommands : public SlurmCluster {
 public:
  void check() override;
  [[nodiscard]] int max_array_size() override;
  [[nodiscard]] std::string submit(const std::filesystem::path& script,
                                   const std::vector<std::string>& options) override;
  [[nodiscard]] std::optional<SlurmQueue> queue(const std::vector<std::string>& arrays) override;
  void cancel(const std::vector<std::string>& arrays) override;
};

}  // namespace saccade
