#pragma once

#include <filesystem>
#include <optional>

#include "eval/metrics/metrics.h"
#include "eval/recording.h"

namespace saccade {

/// Two recordings of the same view: dataset folders or event files.
struct EventsToCompare {
  std::filesystem::path events;  ///< are scored
  std::filesystem::path truth;   ///< against these
  RecordingPart part;            ///< of both
};

/// Scores the events of one recording against those of another (events.*, docs/metrics.md). Into
/// the folder `output`, where one is given, it writes metrics.json and pixels.png, which shows in
/// which pixels events are missing or superfluous. Throws InputError for what cannot be read, for
/// sensors of different size, and where a part of both has no event at all.
Metrics evaluate_events(const EventsToCompare& compared,
                        const std::optional<std::filesystem::path>& output = std::nullopt);

}  // namespace saccade
