#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "core/config/fields.h"
#include "core/event.h"
#include "core/image.h"

namespace saccade {

/// An image from the first `events` events.
struct Snapshot {
  std::size_t events = 0;
  ImageF log_image;
};

/// Describes the key `snapshot_events` of a configuration.
void describe_snapshots(config::Fields& fields, std::vector<std::int64_t>& counts);

/// The images from the first `counts[i]` > 0 of some events, as in thesis figs. 8.14 and 8.15. In
/// parallel.
[[nodiscard]] std::vector<Snapshot> take_snapshots(
    std::span<const Event> events, const std::vector<std::int64_t>& counts,
    const std::function<ImageF(std::span<const Event>)>& log_image_of);

/// growth/growth_%09d.png by number of events; nothing without snapshots.
void write_snapshots(const std::filesystem::path& folder, std::span<const Snapshot> snapshots);

}  // namespace saccade
