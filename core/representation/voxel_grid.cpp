#include "core/representation/voxel_grid.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace saccade {
namespace {

/// As E2VID has it: of the voxels that are not 0, and where they are all alike only their mean.
void normalize_nonzero(EventGrid& grid) {
  double count = 0;
  double sum = 0;
  double squares = 0;
  for (const float value : grid) {
    if (value == 0) continue;
    ++count;
    sum += static_cast<double>(value);
    squares += static_cast<double>(value) * static_cast<double>(value);
  }
  if (count == 0) return;
  const double mean = sum / count;
  const double sigma = std::sqrt(std::max(0.0, squares / count - mean * mean));
  const double scale = sigma > 1e-6 * std::abs(mean) ? 1 / sigma : 1;
  for (float& value : grid)
    if (value != 0) value = static_cast<float>((static_cast<double>(value) - mean) * scale);
}

}  // namespace

void describe(config::Fields& fields, VoxelGridOptions& options) {
  fields.value("bins", options.bins, "Number of bins in time.").range(1, 1000);
  fields.choice("polarity", options.polarity,
                {{"signed", VoxelGridOptions::Polarity::kSigned},
                 {"separate", VoxelGridOptions::Polarity::kSeparate}},
                "Whether OFF events count as -1, or have bins of their own.");
  fields.choice("normalize", options.normalize,
                {{"none", VoxelGridOptions::Normalize::kNone},
                 {"nonzero", VoxelGridOptions::Normalize::kNonzero}},
                "nonzero: the voxels that are not 0 get mean 0 and standard deviation 1.");
  fields.choice(
      "span", options.span,
      {{"events", VoxelGridOptions::Span::kEvents}, {"window", VoxelGridOptions::Span::kWindow}},
      "What the bins divide: the time from the first to the last event of a window, as "
      "E2VID does, or the window.");
  describe_windows(fields, options.window);
}

EventGrid voxel_grid(std::span<const Event> events, const GridWindow& window, SensorSize size,
                     const VoxelGridOptions& options) {
  const auto pixels = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
  const auto bins = static_cast<std::size_t>(options.bins);
  EventGrid grid(static_cast<std::size_t>(options.channels()) * pixels);
  if (events.empty()) return grid;
  const bool by_events = options.span == VoxelGridOptions::Span::kEvents;
  const TimeNs from = by_events ? events.front().t_ns : window.from_ns;
  const TimeNs to = by_events ? events.back().t_ns : window.to_ns;
  const double bins_per_ns = to > from ? (options.bins - 1) / static_cast<double>(to - from) : 0;
  const bool is_signed = options.polarity == VoxelGridOptions::Polarity::kSigned;
  for (const Event& event : events) {
    SACCADE_CHECK(event.x < size.width && event.y < size.height);
    const double t = bins_per_ns * static_cast<double>(event.t_ns - from);
    const auto bin = std::min(static_cast<std::size_t>(t), bins - 1);
    const double late = t - static_cast<double>(bin);
    const double weight = is_signed ? event.polarity : 1;
    const std::size_t first = !is_signed && event.polarity < 0 ? bins : 0;
    float* voxel =
        &grid[(first + bin) * pixels + event.y * static_cast<std::size_t>(size.width) + event.x];
    voxel[0] += static_cast<float>(weight * (1 - late));
    if (bin + 1 < bins) voxel[pixels] += static_cast<float>(weight * late);
  }
  if (options.normalize == VoxelGridOptions::Normalize::kNonzero) normalize_nonzero(grid);
  return grid;
}

}  // namespace saccade
