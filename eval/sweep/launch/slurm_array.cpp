#include "eval/sweep/launch/slurm_array.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>
#include <system_error>

#include "core/check.h"
#include "core/config/config.h"
#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "eval/sweep/launch/slurm_script.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRecordFile = "batch.yaml";

}  // namespace

void describe(config::Fields& fields, SlurmArrayJob& job) {
  fields.value("name", job.name, "Name of the job.").required();
  fields.value("identity", job.identity, "Hash of everything that the result depends on.");
  fields.value("attempt", job.attempt, "Number of the attempt, from 1.");
}

void describe(config::Fields& fields, SlurmArrayRecord& record) {
  fields.value("array", record.array, "Name of the array in Slurm.").required();
  fields.value("jobs_per_task", record.jobs_per_task, "Jobs that one task runs one after another.")
      .range(1, 1e6);
  fields.list("jobs", record.jobs, "Jobs in the order of the tasks.").required();
}

SlurmArray::SlurmArray(const fs::path& parent, SlurmArrayRecord record,
                       std::span<const LaunchJob* const> jobs, const fs::path& program)
    : folder_(parent / record.array), record_(std::move(record)), reported_(jobs.size(), false) {
  SACCADE_CHECK(jobs.size() == record_.jobs.size());
  for (std::size_t i = 0; i < jobs.size(); ++i)
    write_atomically(file(i, "sh"), job_script(*jobs[i]));
  write_atomically(script(), array_script(folder_, program, jobs.size(), record_.jobs_per_task));
  write_atomically(folder_ / kRecordFile, config::print(record_));
}

SlurmArray::SlurmArray(fs::path folder, SlurmArrayRecord record)
    : folder_(std::move(folder)), record_(std::move(record)) {
  for (std::size_t i = 0; i < record_.jobs.size(); ++i)
    reported_.push_back(fs::exists(file(i, "settled")));
}

std::vector<SlurmArray> SlurmArray::find(const fs::path& parent) {
  std::vector<SlurmArray> arrays;
  std::error_code error;
  std::vector<fs::path> folders;
  for (const fs::directory_entry& entry : fs::directory_iterator(parent, error))
    folders.push_back(entry.path());
  std::sort(folders.begin(), folders.end());
  for (const fs::path& folder : folders) try {
      const fs::path file = folder / kRecordFile;
      arrays.push_back(SlurmArray(folder, config::read<SlurmArrayRecord>(config::load(file))));
    } catch (const InputError&) {
      fs::remove_all(folder, error);  // the program was killed before it submitted the array
    }
  return arrays;
}

int SlurmArray::tasks() const { return task_of(record_.jobs.size() - 1) + 1; }

int SlurmArray::task_of(std::size_t job) const {
  return static_cast<int>(job) / record_.jobs_per_task;
}

std::vector<std::string> SlurmArray::options(int parallel_jobs) const {
  std::string tasks = fmt::format("--array=0-{}", this->tasks() - 1);
  if (parallel_jobs < this->tasks()) tasks += fmt::format("%{}", parallel_jobs);
  return {"--job-name=" + record_.array, tasks, "--output=" + (folder_ / "task_%a.txt").string()};
}

std::optional<SlurmExit> SlurmArray::exit_of(std::size_t job) const {
  std::ifstream stream(file(job, "exit"));
  SlurmExit exit;
  double microseconds = 0;
  if (!(stream >> exit.status >> exit.call >> microseconds)) return std::nullopt;
  exit.wall_s = microseconds / 1e6;
  return exit;
}

std::optional<SlurmStart> SlurmArray::start_of(std::size_t job) const {
  std::ifstream stream(file(job, "started"));
  SlurmStart start;
  if (!(stream >> start.node >> start.call)) return std::nullopt;
  return start;
}

std::string SlurmArray::output_of(std::size_t job) const {
  std::ifstream stream(folder_ / fmt::format("task_{}.txt", task_of(job)));
  return {std::istreambuf_iterator<char>(stream), {}};
}

void SlurmArray::mark_reported(std::size_t job) {
  std::ofstream stream(file(job, "settled"));
  reported_[job] = true;
}

bool SlurmArray::all_reported() const {
  return std::find(reported_.begin(), reported_.end(), false) == reported_.end();
}

void SlurmArray::remove() const {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

fs::path SlurmArray::file(std::size_t job, const char* ending) const {
  return folder_ / fmt::format("{}.{}", job, ending);
}

std::string new_array_name() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const auto us = std::chrono::duration_cast<std::chrono::microseconds>(now).count();
  return fmt::format("saccade-{:x}-{:x}", us, ::getpid());
}

}  // namespace saccade
