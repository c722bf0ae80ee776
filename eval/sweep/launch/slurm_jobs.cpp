#include "eval/sweep/launch/slurm_jobs.h"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <map>
#include <set>
#include <thread>

#include "core/child_process.h"
#include "core/error.h"
#include "core/io/atomic_file.h"

namespace saccade {
namespace {

/// How a shell tells a signal.
constexpr int kSignalStatus = 128;
/// Slurm gives a process that was asked to end half a minute (KillWait).
constexpr std::chrono::seconds kUntilKilled{45};
constexpr std::chrono::milliseconds kBetweenLooks{300};

ChildEnd end_of_status(int status) {
  return status > kSignalStatus ? ChildEnd{-1, status - kSignalStatus} : ChildEnd{status, 0};
}

/// The signals with which Slurm ends a job, or the kernel one that takes too much memory.
bool may_be_slurms_doing(int status) {
  return status == kSignalStatus + SIGKILL || status == kSignalStatus + SIGTERM;
}

void append_to(const std::filesystem::path& log, const std::string& text) {
  std::ofstream(log, std::ios::app | std::ios::binary) << text;
}

}  // namespace

SlurmJobs::SlurmJobs(std::span<const LaunchJob> jobs, const LaunchLimits& limits,
                     const LauncherOptions& options, SlurmCluster& cluster,
                     const LaunchCallbacks& events)
    : launches_(jobs),
      limits_(limits),
      options_(options),
      cluster_(cluster),
      events_(events),
      jobs_(jobs.size()),
      batches_(SlurmArray::find(options.folder)),
      largest_array_(options.slurm.arrays_of > 0 ? options.slurm.arrays_of
                                                 : cluster.largest_array()) {}

std::size_t SlurmJobs::take_over() {
  std::vector<std::string> outdated;
  for (std::size_t batch = 0; batch < batches_.size(); ++batch) {
    if (is_outdated(batches_[batch]))
      outdated.push_back(batches_[batch].array());
    else
      adopt(batch);
  }
  if (!outdated.empty()) cancel_arrays(outdated);
  for (const SlurmArray& batch : batches_)
    if (std::find(outdated.begin(), outdated.end(), batch.array()) != outdated.end())
      batch.remove();
  return in_stage(Stage::kQueued).size();
}

bool SlurmJobs::is_outdated(const SlurmArray& batch) const {
  std::map<std::string, std::string> identities;
  for (const LaunchJob& launch : launches_) identities[launch.name] = launch.identity;
  for (std::size_t place = 0; place < batch.jobs().size(); ++place) {
    const auto known = identities.find(batch.jobs()[place].name);
    if (known != identities.end() && known->second != batch.jobs()[place].identity &&
        !batch.is_settled(place))
      return true;
  }
  return false;
}

void SlurmJobs::adopt(std::size_t batch) {
  std::map<std::string, std::size_t> places;
  for (std::size_t i = 0; i < batches_[batch].jobs().size(); ++i)
    if (!batches_[batch].is_settled(i)) places[batches_[batch].jobs()[i].name] = i;
  for (std::size_t i = 0; i < jobs_.size(); ++i) {
    const auto place = places.find(launches_[i].name);
    if (place == places.end()) continue;
    const int attempt = batches_[batch].jobs()[place->second].attempt;
    // Killed between writing a further attempt and settling the one before.
    const bool earlier = jobs_[i].stage == Stage::kQueued && attempt <= jobs_[i].attempts;
    if (earlier)
      batches_[batch].settle(place->second);
    else
      jobs_[i] = {Stage::kQueued, batch, place->second, attempt, {}};
  }
}

std::vector<std::size_t> SlurmJobs::in_stage(Stage stage) const {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < jobs_.size(); ++i)
    if (jobs_[i].stage == stage) found.push_back(i);
  return found;
}

std::vector<std::string> SlurmJobs::queued_arrays() const {
  std::set<std::string> arrays;
  for (const std::size_t i : in_stage(Stage::kQueued))
    arrays.insert(batches_[jobs_[i].batch].array());
  return {arrays.begin(), arrays.end()};
}

SlurmArray SlurmJobs::write_batch(const std::vector<std::size_t>& chosen) const {
  SlurmArrayRecord record{new_array_name(), options_.slurm.jobs_per_task, {}};
  std::vector<const LaunchJob*> launches;
  for (const std::size_t i : chosen) {
    launches.push_back(&launches_[i]);
    record.jobs.push_back({launches_[i].name, launches_[i].identity, jobs_[i].attempts + 1});
    if (jobs_[i].attempts == 0) write_atomically(launches_[i].log, "");
  }
  return {options_.folder, std::move(record), launches, options_.program};
}

void SlurmJobs::submit() {
  std::vector<std::size_t> chosen = in_stage(Stage::kWaiting);
  const bool queued = !in_stage(Stage::kQueued).empty();
  // The limit holds within an array, so that there must be no second one.
  if (chosen.empty() || (queued && limits_.parallel_jobs != LaunchLimits::kAllAtOnce)) return;
  const auto room = static_cast<std::size_t>(largest_array_) *
                    static_cast<std::size_t>(options_.slurm.jobs_per_task);
  chosen.resize(std::min(chosen.size(), room));
  const SlurmArray batch = write_batch(chosen);
  std::vector<std::string> words = batch.options(limits_.parallel_jobs);
  for (std::string& option : sbatch_options(options_.slurm, limits_.threads))
    words.push_back(std::move(option));
  const std::string refusal = cluster_.submit(batch.script(), words);
  if (!refusal.empty()) {
    batch.remove();
    if (!queued) throw InputError("sbatch", refusal);
    return;  // what is queued makes room
  }
  for (std::size_t place = 0; place < chosen.size(); ++place) {
    Job& job = jobs_[chosen[place]];
    job = {Stage::kQueued, batches_.size(), place, job.attempts + 1, {}};
  }
  batches_.push_back(batch);
}

void SlurmJobs::collect() {
  for (const std::size_t i : in_stage(Stage::kQueued)) {
    const std::optional<SlurmExit> exit = batches_[jobs_[i].batch].exit_of(jobs_[i].place);
    if (exit && !may_be_slurms_doing(exit->status)) end_by_exit(i, *exit, {});
  }
}

void SlurmJobs::look() {
  const std::vector<std::string> arrays = queued_arrays();
  if (arrays.empty()) return;
  const std::optional<SlurmQueue> queue = cluster_.queue(arrays);
  if (!queue) return;
  const Clock::time_point now = Clock::now();
  const std::chrono::duration<double> lag(options_.slurm.file_lag_s);
  collect();  // what ended before the queue was asked, so that the rest did not
  for (const std::size_t i : in_stage(Stage::kQueued)) {
    Job& job = jobs_[i];
    const SlurmArray& batch = batches_[job.batch];
    const SlurmTask* task = queue->find(batch.array(), batch.task_of(job.place));
    if (task != nullptr && task->is_alive()) {
      job.over_since.reset();
      continue;
    }
    if (!job.over_since) job.over_since = now;
    if (now - *job.over_since >= lag) judge(i, task == nullptr ? "" : task->state);
  }
}

void SlurmJobs::judge(std::size_t index, const std::string& state) {
  Job& job = jobs_[index];
  const SlurmArray& batch = batches_[job.batch];
  const std::string problem = final_problem(state);
  if (const std::optional<SlurmExit> exit = batch.exit_of(job.place)) {
    end_by_exit(index, *exit, problem);
  } else if (problem.empty()) {
    lose(index, state);
  } else if (state == "CANCELLED" || first_unfinished_of_task(job)) {
    fail(index, problem);
  } else {
    --job.attempts;  // what ended its task was the job before it
    wait_again(job);
  }
}

void SlurmJobs::lose(std::size_t index, const std::string& state) {
  Job& job = jobs_[index];
  const std::optional<SlurmStart> start = batches_[job.batch].start_of(job.place);
  const std::string what =
      fmt::format("{} ({})", start ? "was lost on node " + start->node : "was lost before it began",
                  state.empty() ? "Slurm knows it no more" : "Slurm: " + state);
  if (!first_unfinished_of_task(job)) {
    --job.attempts;
    wait_again(job);
  } else if (job.attempts < options_.slurm.attempts) {
    events_.on_note(fmt::format("job {} {}; attempt {} of {} follows", launches_[index].name, what,
                                job.attempts + 1, options_.slurm.attempts));
    wait_again(job);
  } else {
    fail(index, fmt::format("{}, in the last of {} attempts", what, job.attempts));
  }
}

bool SlurmJobs::first_unfinished_of_task(const Job& job) const {
  const SlurmArray& batch = batches_[job.batch];
  for (std::size_t i = job.place; i-- > 0 && batch.task_of(i) == batch.task_of(job.place);)
    if (!batch.exit_of(i)) return false;
  return true;
}

void SlurmJobs::end_by_exit(std::size_t index, const SlurmExit& exit, const std::string& problem) {
  LaunchResult result{exit.status == 0, {}, {}, exit.wall_s};
  if (!result.succeeded) {
    result.problem = problem.empty() ? end_of_status(exit.status).text() : problem;
    const auto& commands = launches_[index].commands;
    result.failed = commands[std::min(exit.call, commands.size() - 1)];
  }
  end(index, result);
}

void SlurmJobs::fail(std::size_t index, const std::string& problem) {
  const SlurmArray& batch = batches_[jobs_[index].batch];
  const std::optional<SlurmStart> start = batch.start_of(jobs_[index].place);
  append_to(launches_[index].log, batch.output_of(jobs_[index].place));
  const auto& commands = launches_[index].commands;
  const std::size_t call = start ? std::min(start->call, commands.size() - 1) : 0;
  end(index, {false, problem, commands[call], 0});
}

void SlurmJobs::end(std::size_t index, const LaunchResult& result) {
  // A program that is killed in between hears of it again, which is better than never.
  events_.on_end(index, result);
  wait_again(jobs_[index]);
  jobs_[index].stage = Stage::kEnded;
}

void SlurmJobs::wait_again(Job& job) {
  SlurmArray& batch = batches_[job.batch];
  batch.settle(job.place);
  if (batch.all_settled()) batch.remove();
  job.stage = Stage::kWaiting;
  job.over_since.reset();
}

bool SlurmJobs::all_ended() const {
  return std::all_of(jobs_.begin(), jobs_.end(),
                     [](const Job& job) { return job.stage == Stage::kEnded; });
}

void SlurmJobs::cancel() {
  cancel_arrays(queued_arrays());
  collect();
  for (const std::size_t i : in_stage(Stage::kQueued)) wait_again(jobs_[i]);
}

void SlurmJobs::cancel_arrays(const std::vector<std::string>& arrays) {
  cluster_.cancel(arrays);
  const Clock::time_point limit = Clock::now() + kUntilKilled;
  while (Clock::now() < limit) {
    const std::optional<SlurmQueue> queue = cluster_.queue(arrays);
    if (queue && std::none_of(arrays.begin(), arrays.end(),
                              [&](const std::string& array) { return queue->is_alive(array); }))
      return;
    std::this_thread::sleep_for(kBetweenLooks);
  }
}

}  // namespace saccade
