#include "estimator/imu/stabilize_output.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/io/events/events_h5.h"
#include "core/io/files/file_list.h"
#include "core/io/images/image_file.h"
#include "core/process/parallel.h"
#include "core/srgb.h"

namespace saccade {
namespace {

/// An event at its nearest pixel, and with its sub-pixel position.
using PlacedEvent = std::pair<Event, StabilizedEvent>;

std::vector<PlacedEvent> within_image(std::span<const StabilizedEvent> stabilized,
                                      const PinholeCamera& camera) {
  const float right = static_cast<float>(camera.width) - 0.5F;
  const float bottom = static_cast<float>(camera.height) - 0.5F;
  std::vector<PlacedEvent> inside;
  for (const StabilizedEvent& one : stabilized) {
    if (!(one.x > -0.5F && one.y > -0.5F && one.x < right && one.y < bottom)) continue;
    Event event = one.source;
    event.x = static_cast<std::uint16_t>(std::max(std::lround(one.x), 0L));
    event.y = static_cast<std::uint16_t>(std::max(std::lround(one.y), 0L));
    inside.emplace_back(event, one);
  }
  // Readers of events.h5 sort ties in this order; places.h5 must be in the same.
  std::ranges::stable_sort(inside, EventOrder{}, &PlacedEvent::first);
  return inside;
}

}  // namespace

void write_stabilized_events(const std::filesystem::path& folder, const PinholeCamera& camera,
                             std::span<const StabilizedWindow> windows,
                             std::span<const std::vector<StabilizedEvent>> stabilized) {
  std::filesystem::create_directories(folder);
  EventH5Writer events(folder / "events.h5", TimestampUnit::kNanoseconds);
  StabilizedCoordinates coordinates;
  for (const std::vector<StabilizedEvent>& window : stabilized) {
    Events batch;
    for (const auto& [event, exact] : within_image(window, camera)) {
      batch.push_back(event);
      coordinates.x.push_back(exact.x);
      coordinates.y.push_back(exact.y);
      coordinates.source_x.push_back(exact.source.x);
      coordinates.source_y.push_back(exact.source.y);
    }
    events.append(batch);
  }
  events.close();
  write_stabilized_coordinates(folder / "places.h5", coordinates);
  write_stabilized_windows(folder / "windows.csv", windows);
}

void write_stabilized_frames(const std::filesystem::path& folder, const Dataset& dataset,
                             const RunRecord::Window& window, const Stabilizer& stabilizer,
                             const Trajectory& world_from_smoothed) {
  std::vector<std::size_t> frames;
  for (std::size_t i = 0; i < dataset.frames().size(); ++i)
    if (const double t_s = dataset.frames()[i].t_s; t_s >= window.start_s && t_s <= window.end_s)
      frames.push_back(i);
  if (frames.empty()) return;
  std::filesystem::create_directories(folder / "frames");
  std::vector<StampedFile> files(frames.size());
  parallel_for(frames.size(), [&](std::size_t k) {
    const double t_s = dataset.frames()[frames[k]].t_s;
    files[k] = {t_s, folder / "frames" / fmt::format("frame_{:08}.png", frames[k])};
    const ImageF stabilized = stabilizer.stabilize(dataset.load_frame(frames[k]), t_s,
                                                   world_from_smoothed.at_clamped(t_s).rotation());
    write_png(files[k].file, srgb8_from_linear(stabilized));
  });
  write_file_list(folder / "images.txt", files);
}

}  // namespace saccade
