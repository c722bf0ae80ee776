#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace saccade {

/// What squeue says of a task of an array.
struct SlurmTask {
  std::string state;   ///< "RUNNING"
  std::string reason;  ///< why it waits: "Resources"

  /// It waits, runs or is being cleared away.
  [[nodiscard]] bool is_alive() const;
  [[nodiscard]] bool is_running() const;
};

/// The format to ask squeue for, with --array and --noheader.
inline constexpr const char* kSqueueFormat = "%j|%K|%T|%r";

/// What squeue told at one moment.
class SlurmQueue {
 public:
  SlurmQueue() = default;
  /// Lines in that format; others are left out.
  explicit SlurmQueue(std::string_view text);

  /// The task of this number; nullptr where squeue does not tell of it.
  [[nodiscard]] const SlurmTask* find(const std::string& array, int index) const;
  [[nodiscard]] bool is_alive(const std::string& array) const;

 private:
  std::map<std::string, std::map<std::optional<int>, SlurmTask>> arrays_;
};

/// Why another attempt would end alike: its time limit, its memory, or somebody's will
/// ("TIMEOUT" -> "Slurm's time limit"). Empty for a state in which the job was lost
/// (a dead node, a killed script).
[[nodiscard]] std::string final_problem(std::string_view state);

}  // namespace saccade
