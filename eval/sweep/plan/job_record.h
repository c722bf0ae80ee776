#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/config/fields.h"
#include "core/io/files/resumable_folder.h"
#include "eval/sweep/plan/plan.h"

namespace saccade {

/// The contents of job.yaml: the inputs of a finished job. It is written last.
struct JobRecord {
  std::vector<std::string> commands;  ///< as shell commands
  Fingerprint inputs;
  std::string result_sha256;  ///< of SweepJob::marker()
  double wall_s = 0;
};

void describe(config::Fields& fields, JobRecord& record);

/// Computes the inputs of jobs. Every file is read once, so the object must not be used after a
/// file has changed.
class JobInputs {
 public:
  /// Hashes of the program, the settings, the dataset, and the configuration with its includes and
  /// the files that it names (of a scene also the files beside them: materials and textures).
  /// Throws InputError where a configuration cannot be read. A dataset that does not exist yet has
  /// a value of its own.
  [[nodiscard]] Fingerprint of(const SweepJob& job);

 private:
  const Fingerprint& configuration(const std::filesystem::path& file);
  const std::string& dataset(const std::filesystem::path& folder);

  std::map<std::filesystem::path, Fingerprint> configurations_;
  std::map<std::filesystem::path, std::string> datasets_;
};

/// One hash of all inputs.
[[nodiscard]] std::string identity_of(const Fingerprint& inputs);

/// Why a job must run; empty when its output exists, is complete and was made from `inputs`.
[[nodiscard]] std::string why_to_run(const SweepJob& job, const std::filesystem::path& record_file,
                                     const Fingerprint& inputs);

/// Writes the record of a finished job. Throws InputError when its output does not exist.
void write_job_record(const std::filesystem::path& file, const SweepJob& job,
                      const Fingerprint& inputs, double wall_s);

}  // namespace saccade
