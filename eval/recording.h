#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/event.h"
#include "core/io/events/event_file.h"

namespace saccade {

/// Part of a recording, on its own clock [s].
struct RecordingPart {
  std::optional<double> start_s;     ///< default: the first event
  std::optional<double> duration_s;  ///< default: to the last event
};

/// Where the events of a dataset folder or an event file are, none read.
struct RecordingSource {
  std::string name;  ///< of that folder or file
  std::filesystem::path file;
  SensorSize size;  ///< 0: no one states it
  TimeWindow window;
};

/// The events of a dataset folder or an event file.
struct EventRecording {
  std::string name;  ///< of that folder or file
  std::filesystem::path file;
  Events events;
  SensorSize size;              ///< where none is stated: as large as the events ask for
  bool is_size_stated = false;  ///< by a dataset or an event file
};

/// The smallest sensor that holds the events.
[[nodiscard]] SensorSize extent(std::span<const Event> events);

/// Time of its first event [s].
[[nodiscard]] double recording_start_s(const std::filesystem::path& path);

/// Throws InputError for what is not there or holds no events.
[[nodiscard]] RecordingSource find_recording(const std::filesystem::path& path,
                                             const RecordingPart& part = {});

/// Throws InputError for what is not there or cannot be read.
[[nodiscard]] EventRecording read_recording(const std::filesystem::path& path,
                                            const RecordingPart& part = {});

/// EventLabels::origin of these events; empty where the recording has no labels.
[[nodiscard]] std::vector<std::uint8_t> read_origins(const std::filesystem::path& path,
                                                     const RecordingPart& part = {});

}  // namespace saccade
