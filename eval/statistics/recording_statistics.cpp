#include "eval/statistics/recording_statistics.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/io/dataset/dataset.h"
#include "core/io/events/event_file.h"

namespace saccade {
namespace fs = std::filesystem;
namespace {

constexpr double kLongest_s = 86400;

std::string seconds_text(const Event& event) {
  return fmt::format("{:.6f} s", seconds_from_ns(event.t_ns));
}

TimeWindow window_of(const fs::path& file, const RecordingPart& part) {
  TimeWindow window;
  if (part.start_s) window.start_ns = ns_from_seconds(*part.start_s);
  if (part.duration_s) {
    const TimeNs start_ns = part.start_s ? window.start_ns : read_event_file_info(file).first_ns;
    window.end_ns = start_ns + ns_from_seconds(*part.duration_s);
  }
  return window;
}

SensorSize extent(const Events& events) {
  SensorSize size;
  for (const Event& event : events)
    size = {std::max(size.width, event.x + 1), std::max(size.height, event.y + 1)};
  return size;
}

}  // namespace

NamedStatistics statistics_of_recording(const fs::path& path, const RecordingPart& part) {
  if (!fs::exists(path)) throw InputError(path.string(), "is not there");
  fs::path file = path;
  SensorSize size;
  if (fs::is_directory(path)) {
    const Dataset dataset = Dataset::open(path);
    file = dataset.events_file();
    if (file.empty()) throw InputError(path.string(), "holds no events");
    size = {dataset.camera().width, dataset.camera().height};
  }
  const Events events = read_events(file, size, window_of(file, part));
  if (events.empty() || events.front().t_ns == events.back().t_ns)
    throw InputError(file.string(), "holds no two events at different times in this part");
  if (seconds_from_ns(events.back().t_ns - events.front().t_ns) > kLongest_s)
    throw InputError(file.string(), "spans more than a day, from " + seconds_text(events.front()) +
                                        " to " + seconds_text(events.back()) +
                                        "; --start-s and --duration-s choose a part");
  if (size.width == 0) size = extent(events);
  // "data/walls/" has an empty file name.
  const fs::path name = path.has_filename() ? path.filename() : path.parent_path().filename();
  return {name.string(), stream_statistics(events, size)};
}

}  // namespace saccade
