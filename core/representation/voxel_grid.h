#pragma once

#include <span>
#include <vector>

#include "core/config/fields.h"
#include "core/event.h"
#include "core/io/events/event_file.h"
#include "core/representation/event_window.h"

namespace saccade {

/// Event representations are dense arrays of float32: channel by channel, each row by row.
using EventGrid = std::vector<float>;

struct VoxelGridOptions {
  enum class Polarity { kSigned, kSeparate };
  enum class Normalize { kNone, kNonzero };
  enum class Span { kEvents, kWindow };

  int bins = 5;
  Polarity polarity = Polarity::kSigned;
  Normalize normalize = Normalize::kNone;
  Span span = Span::kEvents;
  WindowOptions window;

  [[nodiscard]] int channels() const { return polarity == Polarity::kSigned ? bins : 2 * bins; }
};

void describe(config::Fields& fields, VoxelGridOptions& options);

/// The voxel grid of E2VID (Zhu et al., CVPR 2019; Rebecq et al., TPAMI 2021): each event of
/// polarity p adds p (1 - |b - t*|) to the bins b next to its normalised time
///   t* = (bins - 1) (t - t_0) / (t_1 - t_0)
/// with [t_0, t_1] from the first to the last event, or the window. With polarities apart the ON
/// events have the first `bins` channels, the OFF events the others, both with weights above 0.
/// Normalisation: (value - mean) / standard deviation, over the voxels that are not 0. `events` are
/// those of the window and lie within `size`.
[[nodiscard]] EventGrid voxel_grid(std::span<const Event> events, const GridWindow& window,
                                   SensorSize size, const VoxelGridOptions& options);

}  // namespace saccade
