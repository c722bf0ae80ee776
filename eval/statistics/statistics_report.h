#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "core/image.h"
#include "eval/recording.h"
#include "eval/statistics/stream_statistics.h"

namespace saccade {

/// Statistics of a dataset folder or an event file, named after that folder or file. The sensor of
/// an event file that does not state it is taken to be as large as its events ask for. Throws
/// InputError for what cannot be read, for a part without two events at different times, and for
/// one that spans more than a day.
[[nodiscard]] StreamStatistics statistics_of_recording(const std::filesystem::path& path,
                                                       const RecordingPart& part = {});

/// For a terminal: a row for each quantity, a column for each recording.
[[nodiscard]] std::string statistics_table(std::span<const StreamStatistics> recordings);

/// Rate over time, gaps between events of a pixel, and the rates of all pixels; a line for each
/// recording.
[[nodiscard]] ImageRgb8 draw_statistics(std::span<const StreamStatistics> recordings);

/// Writes statistics.csv (a row for each recording), rates.csv, gaps.csv and statistics.png into
/// `folder` (docs/realism.md).
void write_statistics(std::span<const StreamStatistics> recordings,
                      const std::filesystem::path& folder);

}  // namespace saccade
