#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/process/child_process.h"

namespace saccade {

/// One call of an external program.
struct ExternalCall {
  std::vector<std::string> words;  ///< program and arguments
  std::filesystem::path working_folder;
  std::filesystem::path log;  ///< its output is appended
  double timeout_s = 3600;
};

/// Exit status and resources of a call.
struct ExternalEnd {
  ChildEnd end;
  double wall_s = 0;
  double peak_memory_mb = 0;  ///< of its largest process
  bool timed_out = false;
};

/// Runs the program and waits for its end. At the time-out it receives SIGTERM, five seconds later it
/// is killed with its children. Throws InputError where it cannot be started, and where saccade
/// itself is interrupted, after ending the program.
[[nodiscard]] ExternalEnd run_external_program(const ExternalCall& call);

/// The last lines of a log as the reason of a failure: at most three, of the last repetition.
[[nodiscard]] std::string log_tail(const std::filesystem::path& log);

}  // namespace saccade
