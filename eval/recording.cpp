#include "eval/recording.h"

#include <algorithm>
#include <limits>

#include "core/error.h"
#include "core/io/dataset/dataset.h"
#include "core/io/events/event_formats.h"

namespace saccade {
namespace fs = std::filesystem;
namespace {

TimeWindow window_of(const fs::path& file, const RecordingPart& part) {
  TimeWindow window;
  if (part.start_s) window.start_ns = ns_from_seconds(*part.start_s);
  if (part.duration_s) {
    const TimeNs start_ns = part.start_s ? window.start_ns : read_event_file_info(file).first_ns;
    const TimeNs duration_ns = ns_from_seconds(*part.duration_s);
    const bool is_open = start_ns > 0 && duration_ns > window.end_ns - start_ns;
    if (!is_open) window.end_ns = start_ns + duration_ns;
  }
  return window;
}

fs::path events_file_of(const fs::path& path) {
  if (!fs::exists(event_file_place(path).file)) throw InputError(path.string(), "is not there");
  if (!fs::is_directory(path)) return path;
  fs::path file = Dataset::open(path).events_file();
  if (file.empty()) throw InputError(path.string(), "holds no events");
  return file;
}

}  // namespace

SensorSize extent(std::span<const Event> events) {
  SensorSize size;
  for (const Event& event : events)
    size = {std::max(size.width, event.x + 1), std::max(size.height, event.y + 1)};
  return size;
}

double recording_start_s(const fs::path& path) {
  return seconds_from_ns(read_event_file_info(events_file_of(path)).first_ns);
}

RecordingSource find_recording(const fs::path& path, const RecordingPart& part) {
  if (!fs::exists(event_file_place(path).file)) throw InputError(path.string(), "is not there");
  RecordingSource source;
  // "data/walls/" has an empty file name.
  source.name = (path.has_filename() ? path.filename() : path.parent_path().filename()).string();
  if (fs::is_directory(path)) {
    const Dataset dataset = Dataset::open(path);
    source.file = dataset.events_file();
    if (source.file.empty()) throw InputError(path.string(), "holds no events");
    source.size = {dataset.camera().width, dataset.camera().height};
  } else {
    source.file = path;
    source.size = stated_sensor(path);
  }
  source.window = window_of(source.file, part);
  return source;
}

EventRecording read_recording(const fs::path& path, const RecordingPart& part) {
  const RecordingSource source = find_recording(path, part);
  EventRecording recording{.name = source.name,
                           .file = source.file,
                           .events = read_events(source.file, source.size, source.window),
                           .size = source.size,
                           .is_size_stated = source.size.width > 0};
  if (!recording.is_size_stated) recording.size = extent(recording.events);
  return recording;
}

std::vector<std::uint8_t> read_origins(const fs::path& path, const RecordingPart& part) {
  if (!fs::is_directory(path)) return {};
  const Dataset dataset = Dataset::open(path);
  if (!dataset.has_labels()) return {};
  if (!part.start_s && !part.duration_s) return dataset.load_labels().origin;
  const TimeWindow window = window_of(dataset.events_file(), part);
  constexpr double kForever_s = std::numeric_limits<double>::infinity();
  const bool is_open = !part.duration_s;
  return dataset
      .load_labels(part.start_s ? seconds_from_ns(window.start_ns) : -kForever_s,
                   is_open ? kForever_s : seconds_from_ns(window.end_ns))
      .origin;
}

}  // namespace saccade
