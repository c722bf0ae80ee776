#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "eval/statistics/stream_statistics.h"

namespace saccade {

struct NamedStatistics {
  std::string name;  ///< of the recording, in tables and pictures
  StreamStatistics statistics;
};

/// Part of a recording, on its own clock [s].
struct RecordingPart {
  std::optional<double> start_s;     ///< default: the first event
  std::optional<double> duration_s;  ///< default: to the last event
};

/// Statistics of a dataset folder or an event file, named after that folder or file. The sensor of
/// an event file is taken to be as large as its events ask for. Throws InputError for what cannot
/// be read, and for a part without two events at different times.
[[nodiscard]] NamedStatistics statistics_of_recording(const std::filesystem::path& path,
                                                      const RecordingPart& part = {});

}  // namespace saccade
