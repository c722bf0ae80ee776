#include "eval/sweep/merge.h"

#include <string>
#include <string_view>
#include <system_error>

#include "core/config/config.h"
#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "core/io/files/sha256.h"
#include "core/io/run/run_record.h"
#include "core/process/progress.h"
#include "eval/store/result_store.h"
#include "eval/sweep/plan/job_record.h"
#include "eval/sweep/plan/plan.h"
#include "eval/sweep/sweep_folder.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// "12 bytes of 1769..." -> "12 bytes": copies have other times.
std::string without_time(const std::string& content) {
  constexpr std::string_view kBytes = " bytes";
  const std::size_t at = content.find(" bytes of ");
  return at == std::string::npos ? content : content.substr(0, at + kBytes.size());
}

/// Other machines keep files elsewhere: of a file's path the name counts. The runs that a job starts
/// from are compared as jobs of their own.
Fingerprint without_folders(const Fingerprint& inputs) {
  Fingerprint result;
  for (const auto& [name, content] : inputs) {
    if (name.starts_with("the run ")) continue;
    std::string key = name.starts_with('/') ? fs::path(name).filename().string() : name;
    // Two files of one name in two folders, as scene.yaml: both count.
    while (result.contains(key) && result.at(key) != without_time(content)) key += " (another)";
    result[key] = without_time(content);
  }
  return result;
}

class Merger {
 public:
  Merger(const fs::path& folder, MergeSummary& summary) : folder_(folder), summary_(summary) {}

  void take(const SweepJob& job, std::span<const fs::path> others) {
    if (why_to_run(job, record_in(folder_, job), inputs_of(job)).empty()) {
      ++summary_.there;
      return;
    }
    std::string reason;
    for (const fs::path& other : others) {
      if (!fs::exists(record_in(other, job))) continue;
      reason = take_from(other, job);
      if (reason.empty()) {
        ++summary_.taken;
        return;
      }
    }
    if (!reason.empty()) summary_.refused.emplace_back(job.name, reason);
  }

 private:
  static fs::path record_in(const fs::path& folder, const SweepJob& job) {
    return folder / "jobs" / job.name / "job.yaml";
  }

  /// Computed anew for each job: the merge itself brings their datasets.
  static Fingerprint inputs_of(const SweepJob& job) { return JobInputs().of(job); }

  std::string take_from(const fs::path& other, const SweepJob& job) {
    try {
      const auto record = config::read<JobRecord>(config::load(record_in(other, job)));
      const Fingerprint inputs = inputs_of(job);
      const std::string why = difference(without_folders(record.inputs), without_folders(inputs));
      if (!why.empty()) return why;
      const fs::path source = other / job.output.lexically_relative(folder_);
      if (!fs::exists(source / job.marker())) return "its output is gone";
      if (record.result_sha256 != sha256_of_file(source / job.marker()))
        return "its output was replaced there";
      if (fs::canonical(source) == fs::weakly_canonical(job.output))
        return "its output is the one that is here";
      if (job.makes_run && !job.point.module.empty())
        copy_run(source, job);
      else
        copy_dataset(source, job);
      if (!job.makes_run || job.point.module.empty()) copy_scores(other, job);
      write_job_record(record_in(folder_, job), job, inputs, record.wall_s);
      return "";
    } catch (const InputError& error) {
      return error.what();
    } catch (const fs::filesystem_error& error) {
      return error.what();
    }
  }

  static void copy_run(const fs::path& source, const SweepJob& job) {
    AtomicFolder copy(job.output, job.marker());
    fs::copy(source, copy.path(),
             fs::copy_options::recursive | fs::copy_options::overwrite_existing);
    RunRecord record = read_run_record(copy.path() / "run.yaml");
    record.dataset = job.dataset;
    write_run_record(copy.path() / "run.yaml", record);
    copy.commit();
    keep_result(job.output);
  }

  /// One of the cache is linked, as `saccade simulate --cached` does.
  static void copy_dataset(const fs::path& source, const SweepJob& job) {
    std::error_code error;
    // Of a link the link itself is replaced, not what it leads to.
    if (fs::is_symlink(job.output, error)) fs::remove(job.output);
    if (!fs::is_symlink(source)) {
      AtomicFolder copy(job.output, job.marker());
      fs::copy(source, copy.path(),
               fs::copy_options::recursive | fs::copy_options::overwrite_existing);
      copy.commit();
      return;
    }
    const fs::path target = fs::canonical(source);
    fs::create_directories(job.output.parent_path());
    fs::remove_all(job.output, error);
    fs::create_directory_symlink(target, job.output);
  }

  /// Of events that are scored against those of another dataset.
  void copy_scores(const fs::path& other, const SweepJob& job) const {
    if (job.scores.empty()) return;
    const fs::path source = other / job.scores.lexically_relative(folder_);
    AtomicFolder copy(job.scores.parent_path(), "metrics.json");
    fs::copy(source.parent_path(), copy.path(),
             fs::copy_options::recursive | fs::copy_options::overwrite_existing);
    copy.commit();
  }

  const fs::path& folder_;
  MergeSummary& summary_;
};

}  // namespace

MergeSummary merge_sweeps(const SweepConfig& sweep, const fs::path& folder,
                          std::span<const fs::path> others) {
  check_sweep_folder(folder);
  for (const fs::path& other : others)
    if (!fs::exists(other / "sweep.yaml"))
      throw InputError(other.string(), "holds no sweep (no sweep.yaml) (--merge)");
  const fs::path here = fs::absolute(folder).lexically_normal();
  const SweepPlan plan = plan_sweep(sweep, here);
  fs::create_directories(here);
  const SweepFolderLock lock(here);
  write_atomically(here / "sweep.yaml", config::print(sweep));
  MergeSummary summary;
  Merger merger(here, summary);
  Progress progress("merging", plan.simulations.size() + plan.runs.size(), "jobs");
  for (const auto* jobs : {&plan.simulations, &plan.runs})
    for (const SweepJob& job : *jobs) {
      merger.take(job, others);
      progress.add(1);
    }
  return summary;
}

}  // namespace saccade
