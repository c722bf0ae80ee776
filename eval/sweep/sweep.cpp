#include "eval/sweep/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <system_error>

#include "core/config/config.h"
#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "core/process/parallel.h"
#include "core/process/progress.h"
#include "core/process/shell.h"
#include "eval/metrics/metrics.h"
#include "eval/sweep/plan/calibration_run.h"
#include "eval/sweep/plan/disk_quota.h"
#include "eval/sweep/plan/halving.h"
#include "eval/sweep/plan/job_record.h"
#include "eval/sweep/plan/plan.h"
#include "eval/sweep/result/manifest.h"
#include "eval/sweep/result/results.h"
#include "eval/sweep/status.h"
#include "eval/sweep/sweep_folder.h"

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
      if (job.stage != stage_ || job.state != JobState::kPending) continue;
      const bool no_dataset = job.made_by && has_failed(simulations[*job.made_by]);
      const bool no_source = std::any_of(job.sources.begin(), job.sources.end(),
                                         [&](std::size_t run) { return has_failed(jobs_[run]); });
      if (!no_dataset && !no_source) continue;
      job.state = JobState::kFailed;
      job.failure = no_dataset ? "failed: without its dataset, which failed"
                               : "failed: without the run that it starts from, which failed";
      mark_failed(folder_, job);
    }
  }

  /// False when it was interrupted. `on_wait` is called several times per second.
  bool run(Launcher& launcher, const LaunchLimits& limits, const std::string& label,
           const std::function<void()>& on_wait) {
    select_due(launcher.environment());
    if (due_.empty()) return true;
    const auto all = static_cast<std::size_t>(std::count_if(
        jobs_.begin(), jobs_.end(),
        [&](const SweepJob& job) { return job.stage == stage_ && job.state != JobState::kHeld; }));
    Progress progress(label, all, "jobs", all - due_.size());
    const auto launch = [&](const std::vector<std::size_t>& chosen) {
      std::vector<LaunchJob> launches;
      for (const std::size_t i : chosen) launches.push_back(launches_[i]);
      const auto on_end = [&](std::size_t i, const LaunchResult& result) {
        finish(chosen[i], result, progress);
        progress.add(1);
      };
      return launcher.run(launches, limits,
                          {on_end,
                           [&] {
                             progress.add(0);
                             on_wait();
                           },
                           [&](const std::string& note) { progress.report("saccade: " + note); }});
    };
    const auto [pilots, others] = pilots_and_others(launcher.wants_costs());
    if (!pilots.empty() && !launch(pilots)) return false;
    for (const std::size_t i : others) launches_[i].cost = cost_of_kind(i);
    return others.empty() || launch(others);
  }

 private:
  /// Jobs of one kind take about the same time and memory.
  [[nodiscard]] std::string kind_of(std::size_t launch) const {
    const SweepJob& job = jobs_[due_[launch]];
    return fmt::format("{}|{}|{}|{}", job.config.string(), job.point.configuration,
                       job.point.variant, fmt::join(job.point.grid, "|"));
  }

  /// The first job of each kind, and the rest; without `wanted` none is a pilot.
  [[nodiscard]] std::pair<std::vector<std::size_t>, std::vector<std::size_t>> pilots_and_others(
      bool wanted) const {
    std::set<std::string> kinds;
    std::vector<std::size_t> pilots, others;
    for (std::size_t i = 0; i < launches_.size(); ++i)
      (wanted && kinds.insert(kind_of(i)).second ? pilots : others).push_back(i);
    return {pilots, others};
  }

  [[nodiscard]] std::optional<LaunchJob::Cost> cost_of_kind(std::size_t launch) const {
    const auto known = costs_.find(kind_of(launch));
    return known == costs_.end() ? std::nullopt : std::optional(known->second);
  }

  void remember_cost(std::size_t launch, const LaunchResult& result) {
    LaunchJob::Cost cost{result.wall_s, {}};
    const fs::path timing = jobs_[due_[launch]].output / "timing.json";
    if (fs::exists(timing)) cost.memory_mb = read_json_metrics(timing).get("peak_memory_mb");
    costs_.emplace(kind_of(launch), cost);
  }

  void select_due(const std::string& environment) {
    JobInputs inputs;
    std::vector<std::size_t> asked;
    std::vector<Fingerprint> inputs_of;
    for (std::size_t i = 0; i < jobs_.size(); ++i) {
      if (jobs_[i].stage != stage_ || jobs_[i].state != JobState::kPending) continue;
      asked.push_back(i);
      inputs_of.push_back(inputs.of(jobs_[i]));
      if (!environment.empty()) inputs_of.back()["the container"] = environment;
    }
    // Reading ten thousand records is most of the time of a sweep that is called again.
    std::vector<char> is_due(asked.size());
    parallel_for(asked.size(), [&](std::size_t k) {
      const SweepJob& job = jobs_[asked[k]];
      is_due[k] = !why_to_run(job, record_of(job), inputs_of[k]).empty();
    });
    for (std::size_t k = 0; k < asked.size(); ++k) {
      SweepJob& job = jobs_[asked[k]];
      if (is_due[k]) {
        make_due(asked[k], std::move(inputs_of[k]));
      } else {
        job.state = JobState::kSkipped;
      }
    }
  }

  void make_due(std::size_t i, Fingerprint inputs) {
    const SweepJob& job = jobs_[i];
    fs::remove(record_of(job));
    mark_failed(folder_, job);  // not any more
    due_.push_back(i);
    launches_.push_back(
        {job.name, job.commands, record_of(job).parent_path() / "log.txt", identity_of(inputs)});
    inputs_.push_back(std::move(inputs));
  }

  [[nodiscard]] fs::path record_of(const SweepJob& job) const {
    return folder_ / "jobs" / job.name / "job.yaml";
  }

  void finish(std::size_t launch, const LaunchResult& result, Progress& progress) {
    const std::size_t i = due_[launch];
    const fs::path& log = launches_[launch].log;
    jobs_[i].state = result.succeeded ? JobState::kDone : JobState::kFailed;
    if (result.succeeded) {
      write_job_record(record_of(jobs_[i]), jobs_[i], inputs_[launch], result.wall_s);
      remember_cost(launch, result);
      return;
    }
    jobs_[i].failure = failure_of(result, log, fs::absolute(folder_).lexically_normal());
    mark_failed(folder_, jobs_[i]);
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
  std::map<std::string, LaunchJob::Cost> costs_;  ///< by kind, of the first job that ended
  std::vector<std::size_t> due_;
  std::vector<Fingerprint> inputs_;  ///< of the due jobs
  std::vector<LaunchJob> launches_;  ///< of the due jobs
};

/// Keeps FOLDER/status.html up to date while jobs run, seldom enough to cost next to nothing.
class StatusPage {
 public:
  StatusPage(const SweepConfig& sweep, const SweepPlan& plan, const fs::path& folder)
      : title_(sweep.title.empty() ? "Sweep" : sweep.title), plan_(plan), folder_(folder) {}

  void write_if_due() {
    if (Clock::now() >= next_) write(false);
  }
  void write(bool has_ended) {
    const Clock::time_point start = Clock::now();
    write_atomically(folder_ / "status.html",
                     status_page(sweep_status(plan_, folder_), title_, has_ended));
    const Clock::time_point end = Clock::now();
    next_ = end + std::max<Clock::duration>(kPeriod, kMostLoad * (end - start));
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kPeriod{3};
  static constexpr int kMostLoad = 50;  ///< the other parts of the time for each of writing

  std::string title_;
  const SweepPlan& plan_;
  const fs::path& folder_;
  Clock::time_point next_;
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
  check_sweep_folder(folder);
  SweepPlan plan = plan_sweep(sweep, folder);
  fs::create_directories(folder);
  const SweepFolderLock lock(folder);
  write_atomically(folder / "sweep.yaml", config::print(sweep));
  remove_half_written(folder / "runs");
  if (sweep.generate) check_generated(plan.simulations);
  mark_held(folder, {});
  StatusPage page(sweep, plan, folder);
  const auto on_wait = [&] { page.write_if_due(); };
  bool complete = true;
  std::optional<DiskQuota> quota;
  if (sweep.generate && sweep.generate->disk_gb)
    quota.emplace(*sweep.generate->disk_gb, plan.simulations);
  do {
    for (int stage = 0; complete && stage < SweepPlan::stages(plan.simulations); ++stage) {
      Phase simulations(plan.simulations, stage, folder);
      simulations.fail_without_inputs(plan.simulations);
      complete = simulations.run(launcher, limits_of_simulations(sweep, jobs, launcher),
                                 "simulating", on_wait);
    }
  } while (complete && quota && quota->release_next());
  if (complete && quota && !quota->message().empty()) show_notice(quota->message());
  std::optional<Halving> halving;
  if (sweep.halving) halving.emplace(*sweep.halving, sweep.reference, plan.runs);
  do {
    for (int stage = 0; complete && stage < SweepPlan::stages(plan.runs); ++stage) {
      Phase runs(plan.runs, stage, folder);
      runs.fail_without_inputs(plan.simulations);
      complete = runs.run(launcher, limits_of_runs(sweep, jobs, launcher),
                          stage == 0 ? "running" : "running on", on_wait);
    }
  } while (complete && halving && halving->release_next());
  const std::vector<StoppedRow> stopped = halving ? halving->stopped() : std::vector<StoppedRow>{};
  SweepSummary summary{count(plan, JobState::kDone),
                       count(plan, JobState::kSkipped),
                       count(plan, JobState::kFailed),
                       halving ? count(plan, JobState::kHeld) : 0,
                       0,
                       !complete};
  if (complete) mark_held(folder, plan);
  page.write(true);
  if (sweep.generate) write_manifest(sweep, plan, folder);
  if (complete && (!sweep.generate || !plan.runs.empty()))
    summary.missed = write_sweep_results(sweep, plan, stopped, folder);
  return summary;
}

std::string estimate_generation(const SweepConfig& sweep, const fs::path& folder, int jobs) {
  check_sweep_folder(folder);
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
  const LaunchLimits limits = limits_of_simulations(sweep, jobs, *here);
  return text +
         calibration_text(run_calibration(due, limits, *here), due.size(), limits.parallel_jobs);
}

std::string describe_sweep(const SweepConfig& sweep, const fs::path& folder) {
  check_sweep_folder(folder);
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
  if (sweep.halving) text += "halving will stop rows: not all of these are run\n";
  return text + fmt::format("{} jobs: {} to run, {} done already\n", all, due, all - due);
}

}  // namespace saccade
