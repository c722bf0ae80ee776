#include "apps/convert_grids.h"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <vector>

#include "core/config/config.h"
#include "core/error.h"
#include "core/io/dataset/dataset.h"
#include "core/io/representation/grid_writer.h"
#include "core/representation/event_frame.h"
#include "core/representation/voxel_grid.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// The events with what belongs to them.
struct GridInput {
  Events events;
  SensorSize size;
  std::vector<TimeNs> frames;
};

GridInput load(const fs::path& input) {
  if (!fs::is_directory(input)) {
    GridInput recording{{}, stated_sensor(input), {}};
    if (recording.size.width == 0)
      throw InputError(input.string(),
                       "does not state the size of the sensor; convert the dataset folder, whose "
                       "calibration states it, or events.h5 of this program");
    recording.events = read_events(input, recording.size);
    return recording;
  }
  const Dataset dataset = Dataset::open(input);
  GridInput recording{dataset.load_events(), {dataset.camera().width, dataset.camera().height}, {}};
  for (const StampedFile& frame : dataset.frames())
    recording.frames.push_back(ns_from_seconds(frame.t_s));
  return recording;
}

/// "bins=5,polarity=signed" by the rules of configurations.
template <class Options>
Options parse(const std::string& text, const std::string& option) {
  std::string yaml;
  std::size_t begin = 0;
  while (text != "default" && begin <= text.size()) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string item = text.substr(begin, end - begin);
    const std::size_t equals = item.find('=');
    if (equals == std::string::npos || equals == 0)
      throw InputError(option,
                       fmt::format("'{}' must be key=value, as in bins=5,events=25000", item));
    yaml += item.substr(0, equals) + ": " + item.substr(equals + 1) + "\n";
    begin = end + 1;
  }
  return config::read<Options>(config::parse(yaml.empty() ? "{}" : yaml, option));
}

std::vector<GridWindow> windows_of(const GridInput& recording, const WindowOptions& options,
                                   const fs::path& input) {
  if (options.by_frames && recording.frames.size() < 2)
    throw InputError(input.string(), "has no two frames to cut windows at (by_frames)");
  return cut_windows(recording.events, options, recording.frames);
}

std::span<const Event> events_of(const GridInput& recording, const GridWindow& window) {
  return std::span(recording.events).subspan(window.first, window.last - window.first);
}

std::string text_of(const GridShape& shape, const fs::path& output) {
  return fmt::format("{}: {} x {} x {} x {} ({}, channel, row, column)\n", output.string(),
                     shape.count, shape.channels, shape.height, shape.width, shape.name);
}

}  // namespace

std::string convert_to_grids(const fs::path& input, const fs::path& output,
                             const GridRequest& request) {
  std::optional<VoxelGridOptions> voxels;
  FrameGridOptions frames;
  if (!request.voxel_grid.empty())
    voxels = parse<VoxelGridOptions>(request.voxel_grid, "--voxel-grid");
  else
    frames = parse<FrameGridOptions>(request.event_frame, "--event-frame");
  const GridInput recording = load(input);
  const std::vector<GridWindow> windows =
      windows_of(recording, voxels ? voxels->window : frames.window, input);
  const GridShape shape{voxels ? "voxel_grid" : "event_frame", windows.size(),
                        voxels ? voxels->channels() : frames.channels(), recording.size.height,
                        recording.size.width};
  // Counts are codes; a time surface is at most 1.
  const bool is_surface = frames.kind == FrameGridOptions::Kind::kTimeSurface;
  const bool is_picture = output.extension().empty();
  if (voxels && is_picture)
    throw InputError(output.string(), "voxel grids are no pictures; write .h5 or .npy");
  const std::unique_ptr<GridWriter> writer =
      make_grid_writer(output, shape, is_surface ? 255.0F : 1.0F);
  EventFrameMaker maker(recording.size, frames);
  for (const GridWindow& window : windows) {
    const std::span<const Event> events = events_of(recording, window);
    writer->append(
        voxels ? voxel_grid(events, window, recording.size, *voxels) : maker.next(events, window),
        window);
  }
  writer->close();
  return text_of(shape, output);
}

}  // namespace saccade
