#include "eval/sweep/launch/slurm_script.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <system_error>
#include <vector>

#include "core/error.h"
#include "core/process/shell.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

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
  if [[ $(stat -Lc '%s %Y' "$program") != "$build" ]]; then
    echo "$program is not there or was built anew after this job had been submitted" >>"$log"
    finish 125
  fi
  "$program" "$@" >>"$log" 2>&1 </dev/null || finish $?
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

}  // namespace

std::string array_script(const fs::path& here, const fs::path& program, std::size_t jobs,
                         int jobs_per_task) {
  return "#!/bin/bash\n" +
         fmt::format("# An array of {} jobs of `saccade sweep`.\nhere={}\nprogram={}\nbuild={}\n",
                     jobs, quoted(here.string()), quoted(program.string()),
                     quoted(size_and_second(program))) +
         fmt::format("jobs={} at_a_time={}\n", jobs, jobs_per_task) + kFunctions + kLoop;
}

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

}  // namespace saccade
