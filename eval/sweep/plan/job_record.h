#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/config/fields.h"
#include "core/io/resumable_folder.h"
#include "eval/sweep/plan/plan.h"

namespace saccade {

/// The contents of job.yaml: what a finished job was made of. It is written last.
struct JobRecord {
  std::vector<std::string> commands;  ///< as a shell takes them
  Fingerprint inputs;
  std::string result_sha256;  ///< of the output's marker (dataset.yaml, run.yaml)
  double wall_s = 0;
};

void describe(config::Fields& fields, JobRecord& record);

/// Says what jobs depend on. Files are read once, however many jobs read them, so the object must
/// not outlive a phase in which they stay as they are.
class JobInputs {
 public:
  /// The program, the settings, the configuration with its includes and the files that it names (of
  /// a scene also those beside them: materials and textures), and the dataset. InputError where a
  /// configuration cannot be read; a dataset that is not there yet is an input of its own.
  [[nodiscard]] Fingerprint of(const SweepJob& job);

 private:
  const Fingerprint& configuration(const std::filesystem::path& file);
  const std::string& dataset(const std::filesystem::path& folder);

  std::map<std::filesystem::path, Fingerprint> configurations_;
  std::map<std::filesystem::path, std::string> datasets_;
};

/// A hash of all of it.
[[nodiscard]] std::string identity_of(const Fingerprint& inputs);

/// Why a job must run; empty when its output is there, complete and made of `inputs`.
[[nodiscard]] std::string why_to_run(const SweepJob& job, const std::filesystem::path& record_file,
                                     const Fingerprint& inputs);

/// Records that a job is done. InputError when its output is not there.
void write_job_record(const std::filesystem::path& file, const SweepJob& job,
                      const Fingerprint& inputs, double wall_s);

}  // namespace saccade
