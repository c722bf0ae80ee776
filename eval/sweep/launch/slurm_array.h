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

/// A job of an array.
struct SlurmArrayJob {
  std::string name;
  std::string identity;  ///< LaunchJob's
  int attempt = 1;
  /// How many times the request of its kind it was given, after it exceeded less.
  int request_factor = 1;
};

/// The contents of batch.yaml.
struct SlurmArrayRecord {
  std::string array;      ///< its unique name in Slurm
  int jobs_per_task = 1;  ///< task N runs the jobs N * jobs_per_task ... one after another
  std::vector<SlurmArrayJob> jobs;
};

void describe(config::Fields& fields, SlurmArrayRecord& record);

/// The result that a job wrote when it ended by itself.
struct SlurmExit {
  int status = 0;        ///< exit status of the shell: 128 + number for a signal
  std::size_t call = 0;  ///< index of the last command
  double wall_s = 0;
};

/// What a job wrote when it started.
struct SlurmStart {
  std::string node;
  std::size_t call = 0;  ///< index of the last command that was started
};

/// Jobs that were submitted as one job array, as a folder that outlives this program: the script
/// and the files that the jobs write. The state of a job follows from these files and the queue
/// alone, since a cluster need not keep accounts.
class SlurmArray {
 public:
  /// Writes the folder of a new array. `jobs`: those of the record, in the same order. `container`:
  /// SlurmOptions::container.
  SlurmArray(const std::filesystem::path& parent, SlurmArrayRecord record,
             std::span<const LaunchJob* const> jobs, const std::filesystem::path& program,
             const std::filesystem::path& container = {});
  /// The arrays that earlier programs left in `parent`.
  [[nodiscard]] static std::vector<SlurmArray> find(const std::filesystem::path& parent);

  [[nodiscard]] const std::string& name() const { return record_.array; }
  [[nodiscard]] const std::vector<SlurmArrayJob>& jobs() const { return record_.jobs; }
  [[nodiscard]] int tasks() const;
  [[nodiscard]] int task_of(std::size_t job) const;
  [[nodiscard]] std::filesystem::path script() const { return folder_ / "array.sh"; }
  /// The options of sbatch for this array.
  [[nodiscard]] std::vector<std::string> options(int parallel_jobs) const;

  [[nodiscard]] std::optional<SlurmExit> exit_of(std::size_t job) const;
  [[nodiscard]] std::optional<SlurmStart> start_of(std::size_t job) const;
  /// Messages of Slurm in the output of the job's task.
  [[nodiscard]] std::string output_of(std::size_t job) const;

  /// Records that the result of a job was reported, so that later programs ignore it.
  void mark_reported(std::size_t job);
  [[nodiscard]] bool is_reported(std::size_t job) const { return reported_[job]; }
  [[nodiscard]] bool all_reported() const;
  void remove() const;

 private:
  SlurmArray(std::filesystem::path folder, SlurmArrayRecord record);
  [[nodiscard]] std::filesystem::path file(std::size_t job, const char* ending) const;

  std::filesystem::path folder_;
  SlurmArrayRecord record_;
  std::vector<bool> reported_;
};

/// A unique name for a new array.
[[nodiscard]] std::string new_array_name();

}  // namespace saccade
