#include "eval/sweep/launch/slurm_queue.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

namespace saccade {
namespace {

constexpr std::array<std::string_view, 7> kOver{"COMPLETED", "FAILED",  "NODE_FAIL",    "BOOT_FAIL",
                                                "PREEMPTED", "REVOKED", "LAUNCH_FAILED"};

constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kFinal{{
    {"TIMEOUT", "Slurm's time limit (slurm.time_limit_s, or that of the partition)"},
    {"DEADLINE", "Slurm's deadline"},
    {"OUT_OF_MEMORY", "out of memory (slurm.memory_mb, or the partition's default)"},
    {"CANCELLED", "a cancellation (scancel)"},
}};

/// Cuts the text before the next `separator` off `rest`.
std::string_view next_part(std::string_view& rest, char separator) {
  const std::size_t end = std::min(rest.find(separator), rest.size());
  const std::string_view part = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return part;
}

}  // namespace

bool SlurmTask::is_alive() const {
  return std::find(kOver.begin(), kOver.end(), state) == kOver.end() &&
         final_problem(state).empty();
}

bool SlurmTask::is_running() const { return state == "RUNNING" || state == "COMPLETING"; }

SlurmQueue::SlurmQueue(std::string_view text) {
  while (!text.empty()) {
    std::string_view line = next_part(text, '\n');
    if (std::count(line.begin(), line.end(), '|') != 3) continue;
    const std::string array(next_part(line, '|'));
    const std::string_view index = next_part(line, '|');
    // "N/A" stands for all tasks of the array that have no line of their own.
    int number = 0;
    const bool is_number =
        std::from_chars(index.data(), index.data() + index.size(), number).ec == std::errc();
    SlurmTask& task = arrays_[array][is_number ? std::optional(number) : std::nullopt];
    task.state = next_part(line, '|');
    task.reason = line;
  }
}

const SlurmTask* SlurmQueue::find(const std::string& array, int index) const {
  const auto tasks = arrays_.find(array);
  if (tasks == arrays_.end()) return nullptr;
  auto task = tasks->second.find(index);
  if (task == tasks->second.end()) task = tasks->second.find(std::nullopt);
  return task == tasks->second.end() ? nullptr : &task->second;
}

bool SlurmQueue::is_alive(const std::string& array) const {
  const auto tasks = arrays_.find(array);
  return tasks != arrays_.end() &&
         std::any_of(tasks->second.begin(), tasks->second.end(),
                     [](const auto& task) { return task.second.is_alive(); });
}

std::string final_problem(std::string_view state) {
  for (const auto& [name, problem] : kFinal)
    if (state == name) return std::string(problem);
  return {};
}

}  // namespace saccade
