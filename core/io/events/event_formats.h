#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "core/io/events/event_file.h"

namespace saccade {

/// "recording.bag!/davis/left/events": a file, and which of the streams in it is meant.
struct EventFilePlace {
  std::filesystem::path file;
  std::string member;  ///< with its '/'; empty where none is named
};

/// Splits at the first "!/" where there is no file of the whole name.
[[nodiscard]] EventFilePlace event_file_place(const std::filesystem::path& path);

/// What a format is recognised by.
struct EventFileHead {
  const std::filesystem::path& file;
  std::string_view bytes;  ///< the first 4096, fewer where the file is shorter
};

/// A row of the table of formats. A new format is a reader, a writer where it has one, and a row in
/// event_formats.cpp; datasets, adapters and `saccade convert` read the table (docs/formats.md).
struct EventFormat {
  std::string_view name;    ///< what errors and `saccade info` call it
  std::string_view ending;  ///< with its dot; several rows may share one
  std::string_view help;    ///< a sentence: what such a file holds
  bool states_sensor;       ///< whether its files may state the size of the sensor
  TimestampUnit finest;     ///< the finest unit in which it stores times
  bool (*recognises)(const EventFileHead&);
  std::unique_ptr<EventReader> (*open)(const std::filesystem::path&, SensorSize, TimeWindow);
  EventFileInfo (*read_info)(const std::filesystem::path&);  ///< nullptr: by reading it all
  std::unique_ptr<EventWriter> (*make_writer)(const std::filesystem::path&, TimestampUnit,
                                              SensorSize);  ///< nullptr: is read alone
};

[[nodiscard]] std::span<const EventFormat> event_formats();
/// The row of a file, by its content. InputError where it is missing or of none of the formats.
[[nodiscard]] const EventFormat& recognise_event_format(const std::filesystem::path& file);
/// The row by which a file of this ending is written, the first or the one of this name; nullptr
/// where there is none.
[[nodiscard]] const EventFormat* find_written_format(const std::filesystem::path& file,
                                                     std::string_view name = {});
/// Whether files with this ending hold events.
[[nodiscard]] bool is_event_file_name(const std::filesystem::path& file);

/// The endings of the table, ".h5, .hdf5, .txt", each once; `written`: only of formats that are
/// written.
[[nodiscard]] std::string event_file_endings(bool written);
/// What the events of a dataset folder are called: "events.h5, events.txt", in the table's order.
[[nodiscard]] std::string event_file_names();

}  // namespace saccade
