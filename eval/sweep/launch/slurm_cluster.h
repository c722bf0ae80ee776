#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "eval/sweep/launch/slurm_queue.h"

namespace saccade {

/// A cluster that runs arrays of jobs, known by their names.
class SlurmCluster {
 public:
  SlurmCluster() = default;
  virtual ~SlurmCluster() = default;
  SlurmCluster(const SlurmCluster&) = delete;
  SlurmCluster& operator=(const SlurmCluster&) = delete;

  /// InputError when there is none to be reached from here.
  virtual void check() = 0;
  /// Tasks that one array may have.
  [[nodiscard]] virtual int largest_array() = 0;
  /// Queues a script with the options of sbatch. Why it was refused; empty when it was not.
  [[nodiscard]] virtual std::string submit(const std::filesystem::path& script,
                                           const std::vector<std::string>& options) = 0;
  /// What is known of these arrays; nullopt when Slurm does not answer.
  [[nodiscard]] virtual std::optional<SlurmQueue> queue(const std::vector<std::string>& arrays) = 0;
  virtual void cancel(const std::vector<std::string>& arrays) = 0;
};

/// The cluster of the programs sbatch, squeue, scancel and scontrol on the search path.
class SlurmCommands : public SlurmCluster {
 public:
  void check() override;
  [[nodiscard]] int largest_array() override;
  [[nodiscard]] std::string submit(const std::filesystem::path& script,
                                   const std::vector<std::string>& options) override;
  [[nodiscard]] std::optional<SlurmQueue> queue(const std::vector<std::string>& arrays) override;
  void cancel(const std::vector<std::string>& arrays) override;
};

}  // namespace saccade
