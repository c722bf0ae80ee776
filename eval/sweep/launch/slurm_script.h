#pragma once

#include <filesystem>
#include <string>

#include "eval/sweep/launch/launcher.h"

namespace saccade {

/// The script of an array whose folder is `here`: task N runs HERE/I.sh for its `jobs_per_task`
/// jobs, one after another, of `jobs` in all. A job writes I.started ("node call") and, unless it
/// was killed with its task, I.exit ("status call microseconds"). It refuses to run a build of
/// `program` other than the current one.
[[nodiscard]] std::string array_script(const std::filesystem::path& here,
                                       const std::filesystem::path& program, std::size_t jobs,
                                       int jobs_per_task);

/// The script of a single job, which the array's script includes.
[[nodiscard]] std::string job_script(const LaunchJob& job);

}  // namespace saccade
