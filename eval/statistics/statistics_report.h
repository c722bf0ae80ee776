#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "core/image.h"
#include "eval/statistics/recording_statistics.h"

namespace saccade {

/// For a terminal: a row for each quantity, a column for each recording.
[[nodiscard]] std::string statistics_table(std::span<const NamedStatistics> recordings);

/// Rate over time, gaps between events of a pixel, and the rates of all pixels; a line for each
/// recording.
[[nodiscard]] ImageRgb8 draw_statistics(std::span<const NamedStatistics> recordings);

/// Writes statistics.csv (a row for each recording), rates.csv, gaps.csv and statistics.png into
/// `folder` (docs/realism.md).
void write_statistics(std::span<const NamedStatistics> recordings,
                      const std::filesystem::path& folder);

}  // namespace saccade
