#include "eval/sweep/launch/slurm_array.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <fstream>
#include <iterator>
#include <system_error>

#include "core/check.h"
#include "core/config/config.h"
#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "core/process/shell.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRecordFile = "batch.yaml";

std::string quoted(const std::string& word) { return shell_line(std::vector{word}); }

/// As `stat -Lc '%s %Y'` prints it.
std::string size_and_second(const fs::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0)
    throw InputError(file.string(), std::generic_category().message(errno));
  return fmt::format("{} {}", status.st_size, status.st_mtim.tv_sec);
}

// A time limit or a cancellation reaches the script as SIGTERM. Slurm reports which; the job itself
// must then not write an exit file.
constexpr const char* kFunctions = R"sh(
trap 'exit 143' TERM

# finish STATUS: leaves how the job ended, in one step, and ends it.
finish() {
  echo "$1 $number $((${EPOCHREALTIME//[!0-9]/} - begin))" >"$here/.$i.exit" && mv "$here/.$i.exit" "$here/$i.exit"
  exit
}

# call TITLE WORD...: one call of the program.
call() {
  echo "$(hostname) $number" >"$here/$i.started"
  printf '%s\n' "$1" >>"$log"
  shift
  if [[ $(stat -Lc '%s %Y' "$image") != "$build" ]]; then
    echo "$image is not there or was built anew after this job had been submitted" >>"$log"
    finish 125
  fi
  "${program[@]}" "$@" >>"$log" 2>&1 </dev/null || finish $?
  number=$((number + 1))
}
)sh";

constexpr const char* kLoop = R"sh(
for ((i = SLURM_ARRAY_TASK_ID * at_a_time; i < (SLURM_ARRAY_TASK_ID + 1) * at_a_time && i < jobs; ++i)); do
  [[ ! -e $here/$i.exit ]] || continue
  (
    trap 'exit 143' TERM
    begin=${EPOCHREALTIME//[!0-9]/} number=0
    . "$here/$i.sh"
    number=$((number - 1))
    finish 0
  )
done
exit 0
)sh";

/// The script of an array whose folder is `here`: task N runs HERE/I.sh for its `jobs_per_task`
/// jobs, one after another, of `jobs` in all. A job writes I.started ("node call") and, unless it
/// was killed with its task, I.exit ("status call microseconds"). It refuses to run a build of
/// `program` (or an image `container`) other than the current one.
std::string array_script(const fs::path& here, const fs::path& program, const fs::path& container,
                         std::size_t jobs, int jobs_per_task) {
  const fs::path& image = container.empty() ? program : container;
  // The sweep's folder is not among those that Apptainer shows a container by itself.
  const std::string called = container.empty()
                                 ? "\"$image\""
                                 : fmt::format(
                                       "\"$(command -v apptainer || command -v singularity || echo "
                                       "apptainer)\" exec --bind {} \"$image\" saccade",
                                       quoted(here.parent_path().parent_path().string()));
  return "#!/bin/bash\n" +
         fmt::format(
             "# An array of {} jobs of `saccade sweep`.\nhere={}\nimage={}\nbuild={}\n"
             "program=({})\n",
             jobs, quoted(here.string()), quoted(image.string()), quoted(size_and_second(image)),
             called) +
         fmt::format("jobs={} at_a_time={}\n", jobs, jobs_per_task) + kFunctions + kLoop;
}

/// The script of a single job, which the array's script includes.
std::string job_script(const LaunchJob& job) {
  std::string text = fmt::format("# {}\nlog={}\n", job.name, quoted(job.log.string()));
  for (const std::vector<std::string>& arguments : job.commands) {
    std::vector<std::string> words{"saccade"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    const std::string title = "$ " + shell_line(words);
    text += "call " + quoted(title) + " " + shell_line(arguments) + "\n";
  }
  return text;
}

}  // namespace

void describe(config::Fields& fields, SlurmArrayJob& job) {
  fields.value("name", job.name, "Name of the job.").required();
  fields.value("identity", job.identity, "Hash of everything that the result depends on.");
  fields.value("attempt", job.attempt, "Number of the attempt, from 1.");
  fields
      .value("request_factor", job.request_factor,
             "How many times the usual time and memory it may use.")
      .range(1, 1024);
}

void describe(config::Fields& fields, SlurmArrayRecord& record) {
  fields.value("array", record.array, "Name of the array in Slurm.").required();
  fields.value("jobs_per_task", record.jobs_per_task, "Jobs that one task runs one after another.")
      .range(1, 1e6);
  fields.list("jobs", record.jobs, "Jobs in the order of the tasks.").required();
}

SlurmArray::SlurmArray(const fs::path& parent, SlurmArrayRecord record,
                       std::span<const LaunchJob* const> jobs, const fs::path& program,
                       const fs::path& container)
    : folder_(parent / record.array), record_(std::move(record)), reported_(jobs.size(), false) {
  SACCADE_CHECK(jobs.size() == record_.jobs.size());
  for (std::size_t i = 0; i < jobs.size(); ++i)
    write_atomically(file(i, "sh"), job_script(*jobs[i]));
  write_atomically(script(),
                   array_script(folder_, program, container, jobs.size(), record_.jobs_per_task));
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
