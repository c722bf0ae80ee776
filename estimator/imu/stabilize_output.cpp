#include "estimator/imu/stabilize_output.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/io/events/events_h5.h"
#include "core/io/files/file_list.h"
#include "core/io/images/image_file.h"
#include "core/process/parallel.h"
#include "core/srgb.h"

namespace saccade {
namespace {

/// Where an event ends up: the nearest pixel, and exactly.
struct Placed {
  Event event;
  StabilizedEvent stabilized;
};

std::vector<Placed> within_image(const StabilizedStretch& stretch, const PinholeCamera& camera) {
  const float right = static_cast<float>(camera.width) - 0.5F;
  const float bottom = static_cast<float>(camera.height) - 0.5F;
  std::vector<Placed> placed;
  for (const StabilizedEvent& one : stretch.stabilized) {
    if (!(one.x > -0.5F && one.y > -0.5F && one.x < right && one.y < bottom)) continue;
    Event event = one.source;
    event.x = static_cast<std::uint16_t>(std::max(std::lround(one.x), 0L));
    event.y = static_cast<std::uint16_t>(std::max(std::lround(one.y), 0L));
    placed.push_back({event, one});
  }
  // Readers put ties in this order; the places must be in the same.
  std::stable_sort(placed.begin(), placed.end(),
                   [](const Placed& a, const Placed& b) { return EventOrder{}(a.event, b.event); });
  return placed;
}

}  // namespace

void write_stabilized_events(const std::filesystem::path& folder, const PinholeCamera& camera,
                             std::span<const StabilizedStretch> stretches) {
  std::filesystem::create_directories(folder);
  EventH5Writer events(folder / "events.h5", TimestampUnit::kNanoseconds);
  StabilizedCoordinates places;
  std::vector<StabilizedWindow> windows;
  for (const StabilizedStretch& stretch : stretches) {
    Events batch;
    for (const Placed& one : within_image(stretch, camera)) {
      batch.push_back(one.event);
      places.x.push_back(one.stabilized.x);
      places.y.push_back(one.stabilized.y);
      places.source_x.push_back(one.stabilized.source.x);
      places.source_y.push_back(one.stabilized.source.y);
    }
    events.append(batch);
    windows.push_back(stretch.window);
  }
  events.close();
  write_stabilized_coordinates(folder / "places.h5", places);
  write_stabilized_windows(folder / "windows.csv", windows);
}

void write_stabilized_frames(const std::filesystem::path& folder, const Dataset& dataset,
                             const RunRecord::Window& window, const Stabilizer& stabilizer,
                             const Trajectory& world_from_steady) {
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
                                                   world_from_steady.at_clamped(t_s).rotation());
    write_png(files[k].file, srgb8_from_linear(stabilized));
  });
  write_file_list(folder / "images.txt", files);
}

}  // namespace saccade
