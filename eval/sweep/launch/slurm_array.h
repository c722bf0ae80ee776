#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/config/fields.h"
#include "eval/sweep/launch/launcher.h"

namespace saccade {

/// A job among those of an array.
struct SlurmArrayJob {
  std::string name;
  std::string identity;  ///< LaunchJob's
  int attempt = 1;       ///< so many times it was submitted
};

/// The contents of batch.yaml.
struct SlurmArrayRecord {
  std::string array;      ///< its name in Slurm, of no other array
  int jobs_per_task = 1;  ///< task N runs the jobs N * jobs_per_task ... in turn
  std::vector<SlurmArrayJob> jobs;
};

void describe(config::Fields& fields, SlurmArrayRecord& record);

/// What a job left when it ended by itself.
struct SlurmExit {
  int status = 0;        ///< as a shell tells it: 128 + the signal
  std::size_t call = 0;  ///< the last one made
  double wall_s = 0;
};

/// What a job left when it began.
struct SlurmStart {
  std::string node;
  std::size_t call = 0;  ///< the last one begun
};

/// Jobs that were submitted as one array of Slurm, as a folder that outlives this program: the
/// script, and what the jobs leave behind. That and the queue alone tell what became of them, since
/// a cluster need not keep accounts.
class SlurmArray {
 public:
  /// Writes the folder of a new array. `jobs`: as many as in the record, in its order.
  SlurmArray(const std::filesystem::path& parent, SlurmArrayRecord record,
             std::span<const LaunchJob* const> jobs, const std::filesystem::path& program);
  /// Those that earlier programs left in `parent`.
  [[nodiscard]] static std::vector<SlurmArray> find(const std::filesystem::path& parent);

  [[nodiscard]] const std::string& array() const { return record_.array; }
  [[nodiscard]] const std::vector<SlurmArrayJob>& jobs() const { return record_.jobs; }
  [[nodiscard]] int tasks() const;
  [[nodiscard]] int task_of(std::size_t job) const;
  [[nodiscard]] std::filesystem::path script() const { return folder_ / "array.sh"; }
  /// The options of sbatch that make it this array.
  [[nodiscard]] std::vector<std::string> options(int parallel_jobs) const;

  [[nodiscard]] std::optional<SlurmExit> exit_of(std::size_t job) const;
  [[nodiscard]] std::optional<SlurmStart> start_of(std::size_t job) const;
  /// What Slurm itself said in the output of the job's task.
  [[nodiscard]] std::string output_of(std::size_t job) const;

  /// Nobody needs to hear of this job again.
  void settle(std::size_t job);
  [[nodiscard]] bool is_settled(std::size_t job) const { return settled_[job]; }
  [[nodiscard]] bool all_settled() const;
  void remove() const;

 private:
  SlurmArray(std::filesystem::path folder, SlurmArrayRecord record);
  [[nodiscard]] std::filesystem::path file(std::size_t job, const char* ending) const;

  std::filesystem::path folder_;
  SlurmArrayRecord record_;
  std::vector<bool> settled_;
};

/// A name for an array that no other one has.
[[nodiscard]] std::string new_array_name();

}  // namespace saccade
