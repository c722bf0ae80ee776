#include "estimator/reconstruction/snapshots.h"

#include <fmt/core.h>

#include <algorithm>

#include "core/io/images/image_file.h"
#include "core/process/parallel.h"
#include "estimator/reconstruction/reconstruction_output.h"

namespace saccade {

void describe_snapshots(config::Fields& fields, std::vector<std::int64_t>& counts) {
  fields
      .value("snapshot_events", counts,
             "Numbers of events after which a picture of the image is kept in growth/; an empty "
             "list keeps none. Each takes as long as an image of so many events.")
      .above(0);
}

std::vector<Snapshot> take_snapshots(
    std::span<const Event> events, const std::vector<std::int64_t>& counts,
    const std::function<ImageF(std::span<const Event>)>& log_image_of) {
  std::vector<Snapshot> snapshots(counts.size());
  parallel_for(counts.size(), [&](std::size_t i) {
    const std::size_t count = std::min(events.size(), static_cast<std::size_t>(counts[i]));
    snapshots[i] = {count, log_image_of(events.first(count))};
  });
  return snapshots;
}

void write_snapshots(const std::filesystem::path& folder, std::span<const Snapshot> snapshots) {
  if (snapshots.empty()) return;
  std::filesystem::create_directories(folder / "growth");
  for (const Snapshot& snapshot : snapshots)
    write_png(folder / "growth" / fmt::format("growth_{:09}.png", snapshot.events),
              grey_picture(snapshot.log_image, {}));
}

}  // namespace saccade
