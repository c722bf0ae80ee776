#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace saccade {

/// The format for squeue, with --array and --noheader: name of the array, index of the task, state.
inline constexpr const char* kSqueueFormat = "%j|%K|%T";

/// Whether a task in this state is pending, running or being cleaned up.
[[nodiscard]] bool is_active(std::string_view state);

/// The states of tasks at one moment, as squeue printed them.
class SlurmQueue {
 public:
  SlurmQueue() = default;
  /// Lines of kSqueueFormat; other lines are skipped.
  explicit SlurmQueue(std::string_view text);

  /// The state of a task ("RUNNING"); empty where squeue does not list it.
  [[nodiscard]] std::string state_of(const std::string& array, int index) const;
  /// Whether any task of the array is active.
  [[nodiscard]] bool is_active(const std::string& array) const;

 private:
  std::map<std::string, std::map<std::optional<int>, std::string>> arrays_;
};

/// Why another attempt would end the same way: a time limit, the memory, or a cancellation
/// ("TIMEOUT" -> "Slurm's time limit"). Empty for a state in which the job was lost (a node that
/// failed, a script that was killed).
[[nodiscard]] std::string final_problem(std::string_view state);

}  // namespace saccade
