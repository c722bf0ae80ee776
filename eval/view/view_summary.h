#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

#include "eval/view/view_content.h"

namespace saccade {

/// What a page is told first, as JSON. Whatever is absent in the data is absent here:
///   {"recordings": [{"name", "width", "height", "start_us", "end_us", "slot_us", "events",
///     "camera": [fx, fy, cx, cy], "frames": {"t", "id"}, "depth": {"t", "id", "near", "far"},
///     "truth": bool}],
///    "runs": [{"name", "module", "recording", "problem", "depth": {"t", "id"}, "image": {...}}],
///    "unfinished": [{"name", "frames", "depth_maps", "mb", "reached_us", "width", "height"}]}
/// t [s]; an id is what the picture is asked for by. Events are asked for by slots of slot_us,
/// counted from start_us, which hold about kEventsOfSlot each. Of every list of pictures at most
/// `most_pictures`, evenly spaced.
[[nodiscard]] std::string view_summary(
    const ViewContent& content,
    std::size_t most_pictures = std::numeric_limits<std::size_t>::max());

constexpr std::uint64_t kEventsOfSlot = 65'536;

/// Times [s] and poses of a path as JSON, {"t": [...], "p": [[x, y, z, qx, qy, qz, qw], ...]}; at
/// most 2000 of them, evenly spaced.
[[nodiscard]] std::string path_json(const Trajectory& path);

/// How many events each of `bins` equal parts of the recording has: a JSON list.
[[nodiscard]] std::string event_rate_json(const ViewRecording& recording, int bins);

/// First and last moment of a recording [us]: its events, and where it has none its poses and
/// frames. The last one is not included.
struct ViewSpan {
  std::int64_t start_us = 0;
  std::int64_t end_us = 0;
};
[[nodiscard]] ViewSpan view_span(const ViewRecording& recording);
/// Length of the slots of a recording [us], whole milliseconds.
[[nodiscard]] std::int64_t slot_us(const ViewRecording& recording);

}  // namespace saccade
