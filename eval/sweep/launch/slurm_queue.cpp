#include "eval/sweep/launch/slurm_queue.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

namespace saccade {
namespace {

constexpr std::array<std::string_view, 7> kLostStates{
    "COMPLETED", "FAILED", "NODE_FAIL", "BOOT_FAIL", "PREEMPTED", "REVOKED", "LAUNCH_FAILED"};

constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kFinalStates{{
    {"TIMEOUT", "Slurm's time limit (--slurm-minutes, or that of the partition)"},
    {"DEADLINE", "Slurm's deadline"},
    {"OUT_OF_MEMORY", "out of memory (--slurm-memory-mb, or the partition's default)"},
    {"CANCELLED", "a cancellation (scancel)"},
}};

/// Removes the text before the next `separator` from `rest` and returns it.
std::string_view next_part(std::string_view& rest, char separator) {
  const std::size_t end = std::min(rest.find(separator), rest.size());
  const std::string_view part = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return part;
}

}  // namespace

bool is_active(std::string_view state) {
  return std::find(kLostStates.begin(), kLostStates.end(), state) == kLostStates.end() &&
         final_problem(state).empty();
}

SlurmQueue::SlurmQueue(std::string_view text) {
  while (!text.empty()) {
    std::string_view line = next_part(text, '\n');
    if (std::count(line.begin(), line.end(), '|') != 2) continue;
    const std::string array(next_part(line, '|'));
    const std::string_view index = next_part(line, '|');
    // "N/A" stands for all tasks of the array that are not listed.
    int number = 0;
    const bool is_number =
        std::from_chars(index.data(), index.data() + index.size(), number).ec == std::errc();
    arrays_[array][is_number ? std::optional(number) : std::nullopt] = line;
  }
}

std::string SlurmQueue::state_of(const std::string& array, int index) const {
  const auto tasks = arrays_.find(array);
  if (tasks == arrays_.end()) return {};
  auto task = tasks->second.find(index);
  if (task == tasks->second.end()) task = tasks->second.find(std::nullopt);
  return task == tasks->second.end() ? std::string() : task->second;
}

bool SlurmQueue::is_active(const std::string& array) const {
  const auto tasks = arrays_.find(array);
  return tasks != arrays_.end() &&
         std::any_of(tasks->second.begin(), tasks->second.end(),
                     [](const auto& task) { return saccade::is_active(task.second); });
}

std::string final_problem(std::string_view state) {
  for (const auto& [name, problem] : kFinalStates)
    if (state == name) return std::string(problem);
  return {};
}

}  // namespace saccade
