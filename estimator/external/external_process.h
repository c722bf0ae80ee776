#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/child_process.h"

namespace saccade {

/// A program to be run to its end.
struct ExternalCall {
  std::vector<std::string> words;  ///< the first is the program
  std::map<std::string, std::string> environment;
  std::filesystem::path working_folder;
  std::filesystem::path log;  ///< what it prints is appended
  double timeout_s = 3600;
};

/// How it ended.
struct ExternalEnd {
  ChildEnd end;
  double wall_s = 0;
  double peak_memory_mb = 0;  ///< of the largest of its processes
  bool timed_out = false;
};

/// Runs it and waits. At the time-out it is asked to end (SIGTERM), five seconds later it is killed
/// with all that it started. Throws InputError where it cannot be started, and where this program
/// is interrupted, which takes the other with it.
[[nodiscard]] ExternalEnd run_external_program(const ExternalCall& call);

/// The last lines of a log, for a reason of failure: at most three, without those of its begin.
[[nodiscard]] std::string log_tail(const std::filesystem::path& log);

}  // namespace saccade
