#include "eval/sweep/sweep.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <deque>
#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <system_error>

#include "core/config/config.h"
#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "core/process/progress.h"
#include "core/process/shell.h"
#include "eval/sweep/plan/calibration_run.h"
#include "eval/sweep/plan/job_record.h"
#include "eval/sweep/plan/plan.h"
#include "eval/sweep/result/manifest.h"
#include "eval/sweep/result/results.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kShownLogLines = 12;

std::string command_text(const std::vector<std::string>& arguments) {
  std::vector<std::string> words{"saccade"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return shell_line(words);
}

/// The end of a log, without the command lines.
std::string last_lines(const fs::path& file) {
  std::ifstream stream(file);
  std::deque<std::string> lines;
  for (std::string line; std::getline(stream, line);) {
    if (!line.starts_with("$ saccade ")) lines.push_back(line);
    if (lines.size() > kShownLogLines) lines.pop_front();
  }
  std::string text;
  for (const std::string& line : lines) text += "    " + line + "\n";
  return text;
}

/// What the log of a failed job says, on one line; exit code 2 is that of bad input. Files below
/// `folder` are relative to it.
std::string failure_of(const LaunchResult& result, const fs::path& log, const fs::path& folder) {
  constexpr std::string_view kProgram = "saccade: ", kFailed = "failed: ";
  std::ifstream stream(log);
  std::string message;
  for (std::string line; std::getline(stream, line);)
    if (line.starts_with(kProgram)) message = line.substr(kProgram.size());
  if (message.starts_with(kFailed)) message.erase(0, kFailed.size());
  if (message.empty()) message = result.problem;
  const std::string prefix = folder.string() + "/";
  for (auto at = message.find(prefix); at != std::string::npos; at = message.find(prefix))
    message.erase(at, prefix.size());
  return (result.problem == "exit code 2" ? "refused: " : "failed: ") + message;
}

/// A folder with other contents is left alone.
void check_folder(const fs::path& folder) {
  if (!fs::exists(folder)) return;
  if (!fs::is_directory(folder)) throw InputError(folder.string(), "is not a folder");
  if (!fs::is_empty(folder) && !fs::exists(folder / "sweep.yaml"))
    throw InputError(folder.string(),
                     "is not empty and not a sweep (no sweep.yaml); choose another folder");
}

/// Keeps two programs from filling one folder at the same time; the system releases it when the
/// program ends, however that happens.
class FolderLock {
 public:
  /// `folder` exists. InputError when another program holds it.
  explicit FolderLock(const fs::path& folder)
      : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (descriptor_ < 0) fail_to_write(folder, errno);
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
    ::close(descriptor_);
    throw InputError(folder.string(), "is being filled by another program at this moment");
  }
  ~FolderLock() { ::close(descriptor_); }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

/// Removes what killed estimators left beside the run folders.
void remove_half_written(const fs::path& folder) {
  std::error_code ignored;
  std::vector<fs::path> partial;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename();
    if (name.starts_with('.') && name.find(".partial-") != std::string::npos)
      partial.push_back(entry.path());
  }
  for (const fs::path& path : partial) fs::remove_all(path, ignored);
}

/// Runs the jobs of one stage that are due.
class Phase {
 public:
  Phase(std::vector<SweepJob>& jobs, int stage, const fs::path& folder)
      : jobs_(jobs), stage_(stage), folder_(folder) {}

  /// A job fails whose dataset or source failed. `simulations` may be these jobs.
  void fail_without_inputs(const std::vector<SweepJob>& simulations) {
    const auto has_failed = [](const SweepJob& job) { return job.state == JobState::kFailed; };
    for (SweepJob& job : jobs_) {
      if (job.stage != stage_) continue;
      const bool no_dataset = job.made_by && has_failed(simulations[*job.made_by]);
      const bool no_source = std::any_of(job.sources.begin(), job.sources.end(),
                                         [&](std::size_t run) { return has_failed(jobs_[run]); });
      if (!no_dataset && !no_source) continue;
      job.state = JobState::kFailed;
      job.failure = no_dataset ? "failed: without its dataset, which failed"
                               : "failed: without the run that it starts from, which failed";
    }
  }

  /// False when it was interrupted.
  bool run(Launcher& launcher, const LaunchLimits& limits, const std::string& label) {
    select_due();
    if (due_.empty()) return true;
    const auto all = static_cast<std::size_t>(std::count_if(
        jobs_.begin(), jobs_.end(), [&](const SweepJob& job) { return job.stage == stage_; }));
    Progress progress(label, all, "jobs", all - due_.size());
    const auto on_end = [&](std::size_t i, const LaunchResult& result) {
      finish(i, result, progress);
      progress.add(1);
    };
    return launcher.run(launches_, limits,
                        {on_end, [&] { progress.add(0); },
                         [&](const std::string& note) { progress.report("saccade: " + note); }});
  }

 private:
  void select_due() {
    JobInputs inputs;
    for (std::size_t i = 0; i < jobs_.size(); ++i) {
      SweepJob& job = jobs_[i];
      if (job.stage != stage_ || job.state == JobState::kFailed) continue;
      const fs::path job_folder = folder_ / "jobs" / job.name;
      Fingerprint job_inputs = inputs.of(job);
      if (why_to_run(job, job_folder / "job.yaml", job_inputs).empty()) {
        job.state = JobState::kSkipped;
        continue;
      }
      fs::remove(job_folder / "job.yaml");
      due_.push_back(i);
      inputs_.push_back(std::move(job_inputs));
      launches_.push_back(
          {job.name, job.commands, job_folder / "log.txt", identity_of(inputs_.back())});
    }
  }

  void finish(std::size_t launch, const LaunchResult& result, Progress& progress) {
    const std::size_t i = due_[launch];
    const fs::path& log = launches_[launch].log;
    jobs_[i].state = result.succeeded ? JobState::kDone : JobState::kFailed;
    if (result.succeeded) {
      write_job_record(log.parent_path() / "job.yaml", jobs_[i], inputs_[launch], result.wall_s);
      return;
    }
    jobs_[i].failure = failure_of(result, log, fs::absolute(folder_).lexically_normal());
    report(jobs_[i].name, result, log, progress);
  }

  /// An output that several jobs share is shown once.
  void report(const std::string& name, const LaunchResult& result, const fs::path& log,
              Progress& progress) {
    const std::string end = last_lines(log);
    const auto [first, is_new] = reported_.emplace(end, name);
    if (is_new)
      progress.report(fmt::format("saccade: job {} failed with {}:\n  {}\n  the end of {}:\n{}",
                                  name, result.problem, command_text(result.failed), log.string(),
                                  end));
    else
      progress.report(fmt::format("saccade: job {} failed with {}, as {} did", name, result.problem,
                                  first->second));
  }

  std::vector<SweepJob>& jobs_;
  int stage_;
  fs::path folder_;
  std::map<std::string, std::string>
      reported_;  ///< the end of a log -> the first job that printed it
  std::vector<std::size_t> due_;
  std::vector<Fingerprint> inputs_;  ///< of the due jobs
  std::vector<LaunchJob> launches_;  ///< of the due jobs
};

/// A simulation uses all cores of its machine; the many small ones of `generate` run in parallel.
LaunchLimits limits_of_simulations(const SweepConfig& sweep, int jobs, const Launcher& launcher) {
  const int threads = sweep.generate ? sweep.threads : 0;
  const int usual = launcher.default_parallel_jobs(threads);
  if (sweep.generate && jobs > 0) return {jobs, threads};
  return {jobs > 0 ? std::min(jobs, usual) : usual, threads};
}

LaunchLimits limits_of_runs(const SweepConfig& sweep, int jobs, const Launcher& launcher) {
  if (sweep.timing) return {1, 0};
  const int parallel_jobs = jobs > 0 ? jobs : launcher.default_parallel_jobs(sweep.threads);
  return {parallel_jobs, sweep.threads};
}

std::size_t count(const SweepPlan& plan, JobState state) {
  const auto in = [&](const std::vector<SweepJob>& jobs) {
    return static_cast<std::size_t>(std::count_if(
        jobs.begin(), jobs.end(), [&](const SweepJob& job) { return job.state == state; }));
  };
  return in(plan.simulations) + in(plan.runs);
}

/// Why a job would run, as far as it is known before its dataset exists.
std::string preview(const SweepJob& job, const fs::path& folder, JobInputs& inputs,
                    const std::set<fs::path>& to_be_made) {
  if (to_be_made.contains(job.dataset)) return "its dataset is to be simulated";
  for (const fs::path& run : job.source_runs)
    if (to_be_made.contains(run)) return "the run that it starts from is to be made";
  return why_to_run(job, folder / "jobs" / job.name / "job.yaml", inputs.of(job));
}

/// Reports an unknown key before a thousand jobs do.
void check_generated(const std::vector<SweepJob>& simulations) {
  std::vector<const SweepJob*> jobs;
  for (const SweepJob& job : simulations) jobs.push_back(&job);
  check_configurations(jobs, *make_launcher("local"));
}

}  // namespace

SweepSummary run_sweep(const SweepConfig& sweep, const fs::path& folder, Launcher& launcher,
                       int jobs) {
  check_folder(folder);
  SweepPlan plan = plan_sweep(sweep, folder);
  fs::create_directories(folder);
  const FolderLock lock(folder);
  write_atomically(folder / "sweep.yaml", config::print(sweep));
  remove_half_written(folder / "runs");
  if (sweep.generate) check_generated(plan.simulations);
  bool complete = true;
  for (int stage = 0; complete && stage < SweepPlan::stages(plan.simulations); ++stage) {
    Phase simulations(plan.simulations, stage, folder);
    simulations.fail_without_inputs(plan.simulations);
    complete =
        simulations.run(launcher, limits_of_simulations(sweep, jobs, launcher), "simulating");
  }
  for (int stage = 0; complete && stage < SweepPlan::stages(plan.runs); ++stage) {
    Phase runs(plan.runs, stage, folder);
    runs.fail_without_inputs(plan.simulations);
    complete = runs.run(launcher, limits_of_runs(sweep, jobs, launcher),
                        stage == 0 ? "running" : "running on");
  }
  SweepSummary summary{count(plan, JobState::kDone), count(plan, JobState::kSkipped),
                       count(plan, JobState::kFailed), 0, !complete};
  if (sweep.generate) write_manifest(sweep, plan, folder);
  if (complete && (!sweep.generate || !plan.runs.empty()))
    summary.missed = write_sweep_results(sweep, plan, folder);
  return summary;
}

std::string estimate_generation(const SweepConfig& sweep, const fs::path& folder, int jobs) {
  check_folder(folder);
  const SweepPlan plan = plan_sweep(sweep, folder);
  JobInputs inputs;
  std::vector<const SweepJob*> due;
  for (const SweepJob& job : plan.simulations)
    if (!preview(job, folder, inputs, {}).empty()) due.push_back(&job);
  std::string text =
      fmt::format("{} datasets: {} to simulate, {} done already\n", plan.simulations.size(),
                  due.size(), plan.simulations.size() - due.size());
  if (!plan.runs.empty()) text += fmt::format("and {} runs over them\n", plan.runs.size());
  if (due.empty()) return text;
  text += "the first of them:\n  " + command_text(due.front()->commands.front()) + "\n";
  const std::unique_ptr<Launcher> here = make_launcher("local");
  const int parallel_jobs = limits_of_simulations(sweep, jobs, *here).parallel_jobs;
  return text + calibration_text(run_calibration(due, *here), due.size(), parallel_jobs);
}

std::string describe_sweep(const SweepConfig& sweep, const fs::path& folder) {
  check_folder(folder);
  const SweepPlan plan = plan_sweep(sweep, folder);
  JobInputs inputs;
  std::string text;
  std::set<fs::path> to_be_made;
  std::size_t due = 0;
  for (const auto* jobs : {&plan.simulations, &plan.runs})
    for (const SweepJob& job : *jobs) {
      const std::string why = preview(job, folder, inputs, to_be_made);
      text += fmt::format("{} {}{}\n", why.empty() ? "skip" : "run ", job.name,
                          why.empty() ? "" : ": " + why);
      if (why.empty()) continue;
      ++due;
      to_be_made.insert(job.output);
      for (const std::vector<std::string>& command : job.commands)
        text += "  " + command_text(command) + "\n";
    }
  const std::size_t all = plan.simulations.size() + plan.runs.size();
  return text + fmt::format("{} jobs: {} to run, {} done already\n", all, due, all - due);
}

}  // namespace saccade
