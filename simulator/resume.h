#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <vector>

#include "core/io/files/input_log.h"
#include "core/io/files/resumable_folder.h"
#include "simulator/event_log.h"
#include "simulator/simulation_config.h"

namespace saccade {

/// Everything that a dataset's bytes depend on: the configuration, the files that were read, and
/// this program.
[[nodiscard]] Fingerprint fingerprint_of(const SimulationConfig& config, const InputLog& inputs);

/// Where the journal of an unfinished dataset (ResumableFolder::journal()) keeps the log of a camera.
[[nodiscard]] std::filesystem::path event_log_folder(const std::filesystem::path& journal,
                                                     std::size_t camera);

using EventLogs = std::vector<std::unique_ptr<EventLog>>;

/// The logs of `cameras` cameras in `output`, from where an interrupted program left off. When one
/// of them is damaged, all that it left is thrown away. Says in one line what became of it.
[[nodiscard]] EventLogs open_logs(ResumableFolder& output, std::size_t cameras, double duration_s);

}  // namespace saccade
