#include "eval/sweep/launch/slurm_jobs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <fstream>
#include <map>
#include <set>
#include <thread>

#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "core/process/child_process.h"

namespace saccade {
namespace {

/// A shell reports a signal as 128 + its number.
constexpr int kSignalStatus = 128;
/// Slurm kills a process 30 s after it asked it to end (KillWait).
constexpr std::chrono::seconds kCancelTimeout{45};
constexpr std::chrono::milliseconds kPollPeriod{300};
/// A job that is lost on three nodes is more likely the cause than they are.
constexpr int kMaxAttempts = 3;

ChildEnd end_of_status(int status) {
  return status > kSignalStatus ? ChildEnd{-1, status - kSignalStatus} : ChildEnd{status, 0};
}

/// The signals with which Slurm ends a job, and the kernel one that uses too much memory.
bool may_be_killed_by_slurm(int status) {
  return status == kSignalStatus + SIGKILL || status == kSignalStatus + SIGTERM;
}

void append_to(const std::filesystem::path& log, const std::string& text) {
  std::ofstream(log, std::ios::app | std::ios::binary) << text;
}

}  // namespace

SlurmJobs::SlurmJobs(std::span<const LaunchJob> jobs, const LaunchLimits& limits,
                     const LauncherOptions& options, SlurmCluster& cluster,
                     const LaunchCallbacks& callbacks)
    : launches_(jobs),
      limits_(limits),
      options_(options),
      cluster_(cluster),
      callbacks_(callbacks),
      jobs_(jobs.size()),
      arrays_(SlurmArray::find(options.folder)),
      max_array_size_(options.slurm.max_array_size > 0 ? options.slurm.max_array_size
                                                       : cluster.max_array_size()) {}

std::size_t SlurmJobs::adopt_submitted() {
  std::vector<std::string> outdated;
  for (std::size_t array = 0; array < arrays_.size(); ++array) {
    if (is_outdated(arrays_[array]))
      outdated.push_back(arrays_[array].name());
    else
      adopt(array);
  }
  if (!outdated.empty()) cancel_arrays(outdated);
  for (const SlurmArray& array : arrays_)
    if (std::find(outdated.begin(), outdated.end(), array.name()) != outdated.end()) array.remove();
  return in_state(State::kSubmitted).size();
}

bool SlurmJobs::is_outdated(const SlurmArray& array) const {
  std::map<std::string, std::string> identities;
  for (const LaunchJob& launch : launches_) identities[launch.name] = launch.identity;
  for (std::size_t i = 0; i < array.jobs().size(); ++i) {
    const auto known = identities.find(array.jobs()[i].name);
    if (known != identities.end() && known->second != array.jobs()[i].identity &&
        !array.is_reported(i))
      return true;
  }
  return false;
}

void SlurmJobs::adopt(std::size_t array) {
  std::map<std::string, std::size_t> indices;  // in the array, by name
  for (std::size_t i = 0; i < arrays_[array].jobs().size(); ++i)
    if (!arrays_[array].is_reported(i)) indices[arrays_[array].jobs()[i].name] = i;
  for (std::size_t i = 0; i < jobs_.size(); ++i) {
    const auto found = indices.find(launches_[i].name);
    if (found == indices.end()) continue;
    const int attempt = arrays_[array].jobs()[found->second].attempt;
    // The program was killed after it wrote another attempt and before it marked the previous one.
    const bool earlier = jobs_[i].state == State::kSubmitted && attempt <= jobs_[i].attempts;
    if (earlier)
      arrays_[array].mark_reported(found->second);
    else
      jobs_[i] = {State::kSubmitted,
                  array,
                  found->second,
                  attempt,
                  arrays_[array].jobs()[found->second].request_factor,
                  {},
                  {}};
  }
}

std::vector<std::size_t> SlurmJobs::in_state(State state) const {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < jobs_.size(); ++i)
    if (jobs_[i].state == state) found.push_back(i);
  return found;
}

std::vector<std::string> SlurmJobs::submitted_arrays() const {
  std::set<std::string> arrays;
  for (const std::size_t i : in_state(State::kSubmitted))
    arrays.insert(arrays_[jobs_[i].array].name());
  return {arrays.begin(), arrays.end()};
}

SlurmArray SlurmJobs::write_array(const std::vector<std::size_t>& chosen) const {
  SlurmArrayRecord record{new_array_name(), options_.slurm.jobs_per_task, {}};
  std::vector<const LaunchJob*> launches;
  for (const std::size_t i : chosen) {
    launches.push_back(&launches_[i]);
    record.jobs.push_back(
        {launches_[i].name, launches_[i].identity, jobs_[i].attempts + 1, jobs_[i].request_factor});
    if (jobs_[i].attempts == 0) write_atomically(launches_[i].log, "");
  }
  return {options_.folder, std::move(record), launches, options_.program, options_.slurm.container};
}

SlurmRequest SlurmJobs::request_of(std::size_t index) const {
  SlurmRequest request = options_.slurm.request;
  if (const std::optional<LaunchJob::Cost>& cost = launches_[index].cost)
    request = request_like(cost->wall_s, cost->memory_mb);
  if (!request.memory_mb) request.memory_mb = options_.slurm.request.memory_mb;
  for (int factor = jobs_[index].request_factor; factor > 1; factor /= 2)
    request = request.doubled();
  return request;
}

std::vector<std::size_t> SlurmJobs::next_of_one_request() const {
  const Clock::time_point now = Clock::now();
  std::vector<std::size_t> chosen;
  SlurmRequest request;
  for (const std::size_t i : in_state(State::kPending)) {
    if (jobs_[i].not_before && now < *jobs_[i].not_before) continue;
    if (chosen.empty()) request = request_of(i);
    if (request_of(i) == request) chosen.push_back(i);
  }
  return chosen;
}

void SlurmJobs::submit() {
  std::vector<std::size_t> chosen = next_of_one_request();
  const bool submitted = !in_state(State::kSubmitted).empty();
  // Slurm applies the limit within one array; there must not be a second one.
  if (chosen.empty() || (submitted && limits_.parallel_jobs != LaunchLimits::kUnlimited)) return;
  const auto room = static_cast<std::size_t>(max_array_size_) *
                    static_cast<std::size_t>(options_.slurm.jobs_per_task);
  chosen.resize(std::min(chosen.size(), room));
  const SlurmArray array = write_array(chosen);
  std::vector<std::string> words = array.options(limits_.parallel_jobs);
  for (std::string& option :
       sbatch_options(options_.slurm, limits_.threads, request_of(chosen.front())))
    words.push_back(std::move(option));
  const std::string refusal = cluster_.submit(array.script(), words);
  if (!refusal.empty()) {
    array.remove();
    if (!submitted) throw InputError("sbatch", refusal);
    return;  // jobs that end make room
  }
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    Job& job = jobs_[chosen[i]];
    job = {State::kSubmitted, arrays_.size(), i, job.attempts + 1, job.request_factor, {}, {}};
  }
  arrays_.push_back(array);
}

void SlurmJobs::collect_exits() {
  for (const std::size_t i : in_state(State::kSubmitted)) {
    const std::optional<SlurmExit> exit = arrays_[jobs_[i].array].exit_of(jobs_[i].index);
    if (exit && !may_be_killed_by_slurm(exit->status)) finish_by_exit(i, *exit, {});
  }
}

void SlurmJobs::poll_queue() {
  const std::vector<std::string> arrays = submitted_arrays();
  if (arrays.empty()) return;
  const std::optional<SlurmQueue> queue = cluster_.queue(arrays);
  if (!queue) return;
  const Clock::time_point now = Clock::now();
  const std::chrono::duration<double> lag(options_.slurm.file_lag_s);
  collect_exits();  // what ended before the queue was asked; the rest had not
  for (const std::size_t i : in_state(State::kSubmitted)) {
    Job& job = jobs_[i];
    const SlurmArray& array = arrays_[job.array];
    const std::string state = queue->state_of(array.name(), array.task_of(job.index));
    if (!state.empty() && is_active(state)) {
      job.inactive_since.reset();
      continue;
    }
    if (!job.inactive_since) job.inactive_since = now;
    if (now - *job.inactive_since >= lag) resolve(i, state);
  }
}

void SlurmJobs::resolve(std::size_t index, const std::string& state) {
  Job& job = jobs_[index];
  const SlurmArray& array = arrays_[job.array];
  const std::string problem = final_problem(state);
  if (retry_with_more(index, state)) {
    jobs_[index].request_factor *= 2;
    make_pending(job);
  } else if (const std::optional<SlurmExit> exit = array.exit_of(job.index)) {
    finish_by_exit(index, *exit, problem);
  } else if (problem.empty()) {
    handle_lost(index, state);
  } else if (state == "CANCELLED" || first_unfinished_of_task(job)) {
    fail(index, problem);
  } else {
    --job.attempts;  // an earlier job of the task caused its end
    make_pending(job);
  }
}

bool SlurmJobs::retry_with_more(std::size_t index, const std::string& state) {
  const Job& job = jobs_[index];
  const SlurmRequest request = request_of(index);
  const bool was_exceeded =
      (state == "TIMEOUT" && request.minutes) || (state == "OUT_OF_MEMORY" && request.memory_mb);
  const std::optional<SlurmExit> exit = arrays_[job.array].exit_of(job.index);
  const bool ended_by_itself = exit && !may_be_killed_by_slurm(exit->status);
  if (!was_exceeded || ended_by_itself || job.attempts >= kMaxAttempts ||
      !first_unfinished_of_task(job))
    return false;
  const SlurmRequest more = request.doubled();
  callbacks_.on_note(fmt::format("job {} exceeded its {}; attempt {} of {} follows with {}",
                                 launches_[index].name, state == "TIMEOUT" ? "time" : "memory",
                                 job.attempts + 1, kMaxAttempts,
                                 state == "TIMEOUT" ? fmt::format("{:.0f} minutes", *more.minutes)
                                                    : fmt::format("{:.0f} MB", *more.memory_mb)));
  return true;
}

void SlurmJobs::handle_lost(std::size_t index, const std::string& state) {
  Job& job = jobs_[index];
  const std::optional<SlurmStart> start = arrays_[job.array].start_of(job.index);
  const std::string what =
      fmt::format("{} ({})", start ? "was lost on node " + start->node : "was lost before it began",
                  state.empty() ? "Slurm no longer knows it" : "Slurm: " + state);
  if (!first_unfinished_of_task(job)) {
    --job.attempts;
    make_pending(job);
  } else if (job.attempts < kMaxAttempts) {
    // What ended it may last: a node that is down, a partition that others preempt.
    const double wait_s = options_.slurm.backoff_s * std::pow(2, job.attempts - 1);
    callbacks_.on_note(fmt::format("job {} {}; attempt {} of {} follows in {:.0f} s",
                                   launches_[index].name, what, job.attempts + 1, kMaxAttempts,
                                   wait_s));
    make_pending(job);
    job.not_before = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                        std::chrono::duration<double>(wait_s));
  } else {
    fail(index, fmt::format("{}, in the last of {} attempts", what, job.attempts));
  }
}

bool SlurmJobs::first_unfinished_of_task(const Job& job) const {
  const SlurmArray& array = arrays_[job.array];
  for (std::size_t i = job.index; i-- > 0 && array.task_of(i) == array.task_of(job.index);)
    if (!array.exit_of(i)) return false;
  return true;
}

void SlurmJobs::finish_by_exit(std::size_t index, const SlurmExit& exit,
                               const std::string& problem) {
  LaunchResult result{exit.status == 0, {}, {}, exit.wall_s};
  if (!result.succeeded) {
    result.problem = problem.empty() ? end_of_status(exit.status).text() : problem;
    const auto& commands = launches_[index].commands;
    result.failed = commands[std::min(exit.call, commands.size() - 1)];
  }
  finish(index, result);
}

void SlurmJobs::fail(std::size_t index, const std::string& problem) {
  const SlurmArray& array = arrays_[jobs_[index].array];
  const std::optional<SlurmStart> start = array.start_of(jobs_[index].index);
  append_to(launches_[index].log, array.output_of(jobs_[index].index));
  const auto& commands = launches_[index].commands;
  const std::size_t call = start ? std::min(start->call, commands.size() - 1) : 0;
  finish(index, {false, problem, commands[call], 0});
}

void SlurmJobs::finish(std::size_t index, const LaunchResult& result) {
  // Reported first: a program that is killed here reports it twice rather than never.
  callbacks_.on_end(index, result);
  make_pending(jobs_[index]);
  jobs_[index].state = State::kFinished;
}

void SlurmJobs::make_pending(Job& job) {
  SlurmArray& array = arrays_[job.array];
  array.mark_reported(job.index);
  if (array.all_reported()) array.remove();
  job.state = State::kPending;
  job.inactive_since.reset();
}

bool SlurmJobs::all_finished() const {
  return std::all_of(jobs_.begin(), jobs_.end(),
                     [](const Job& job) { return job.state == State::kFinished; });
}

void SlurmJobs::cancel() {
  cancel_arrays(submitted_arrays());
  collect_exits();
  for (const std::size_t i : in_state(State::kSubmitted)) make_pending(jobs_[i]);
}

void SlurmJobs::cancel_arrays(const std::vector<std::string>& arrays) {
  cluster_.cancel(arrays);
  const Clock::time_point limit = Clock::now() + kCancelTimeout;
  while (Clock::now() < limit) {
    const std::optional<SlurmQueue> queue = cluster_.queue(arrays);
    if (queue && std::none_of(arrays.begin(), arrays.end(),
                              [&](const std::string& array) { return queue->is_active(array); }))
      return;
    std::this_thread::sleep_for(kPollPeriod);
  }
}

}  // namespace saccade
