#include "estimator/imu/stabilize_output.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>

#include "core/io/files/file_list.h"
#include "core/io/images/image_file.h"
#include "core/process/parallel.h"
#include "core/srgb.h"

namespace saccade {
namespace {

/// Events at their nearest pixels, and their sub-pixel positions.
struct PlacedEvents {
  Events events;
  StabilizedCoordinates places;
};

/// Brings the events of one time into the order in which readers of events.h5 sort ties; places.h5 must
/// be in the same. Those of different times are in order already.
void sort_runs(std::span<const StabilizedEvent> stabilized, const Events& placed,
               std::vector<std::uint32_t>& order) {
  const auto is_before = [&](std::uint32_t a, std::uint32_t b) {
    return EventOrder{}(placed[a], placed[b]);
  };
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin + 1;
    while (end < order.size() &&
           stabilized[order[end]].source.t_ns == stabilized[order[begin]].source.t_ns)
      ++end;
    const auto first = order.begin() + static_cast<std::ptrdiff_t>(begin);
    if (end - begin > 1)
      std::stable_sort(first, order.begin() + static_cast<std::ptrdiff_t>(end), is_before);
    begin = end;
  }
}

PlacedEvents within_image(std::span<const StabilizedEvent> stabilized,
                          const PinholeCamera& camera) {
  const float right = static_cast<float>(camera.width) - 0.5F;
  const float bottom = static_cast<float>(camera.height) - 0.5F;
  // In double precision the sum is exact: halves are rounded up, and the rest to the nearest.
  const auto nearest = [](float u) {
    return static_cast<std::uint16_t>(std::max(static_cast<double>(u) + 0.5, 0.0));
  };
  Events placed(stabilized.size());
  std::vector<std::uint32_t> order;
  order.reserve(stabilized.size());
  for (std::size_t i = 0; i < stabilized.size(); ++i) {
    const StabilizedEvent& one = stabilized[i];
    if (!(one.x > -0.5F && one.y > -0.5F && one.x < right && one.y < bottom)) continue;
    placed[i] = {one.source.t_ns, nearest(one.x), nearest(one.y), one.source.polarity};
    order.push_back(static_cast<std::uint32_t>(i));
  }
  sort_runs(stabilized, placed, order);
  PlacedEvents inside;
  inside.events.reserve(order.size());
  for (const std::uint32_t i : order) {
    const StabilizedEvent& one = stabilized[i];
    inside.events.push_back(placed[i]);
    inside.places.x.push_back(one.x);
    inside.places.y.push_back(one.y);
    inside.places.source_x.push_back(one.source.x);
    inside.places.source_y.push_back(one.source.y);
  }
  return inside;
}

/// The folder of a writer, which makes files in it as soon as it is made.
const std::filesystem::path& created(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  return folder;
}

}  // namespace

StabilizedEventsWriter::StabilizedEventsWriter(const std::filesystem::path& folder,
                                               const PinholeCamera& camera)
    : folder_(created(folder)),
      camera_(camera),
      events_(folder_ / "events.h5", TimestampUnit::kNanoseconds),
      places_(folder_ / "places.h5") {}

void StabilizedEventsWriter::append(std::span<const StabilizedWindow> windows,
                                    std::span<const std::vector<StabilizedEvent>> stabilized) {
  std::vector<PlacedEvents> placed(stabilized.size());
  parallel_for(placed.size(),
               [&](std::size_t i) { placed[i] = within_image(stabilized[i], camera_); });
  for (const PlacedEvents& window : placed) {
    events_.append(window.events);
    places_.append(window.places);
  }
  windows_.insert(windows_.end(), windows.begin(), windows.end());
}

void StabilizedEventsWriter::close() {
  events_.close();
  places_.close();
  write_stabilized_windows(folder_ / "windows.csv", windows_);
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
