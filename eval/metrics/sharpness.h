#pragma once

#include <vector>

#include "core/image.h"
#include "core/io/dataset/dataset.h"
#include "core/io/events/stabilized_events.h"
#include "eval/metrics/metrics.h"

namespace saccade {

/// What `saccade run stabilize` wrote, or any program in its layout: events.h5, places.h5 and
/// windows.csv of one folder.
struct StabilizedRun {
  Events events;                      ///< at the nearest pixel, in order of time
  StabilizedCoordinates coordinates;  ///< of the same
  std::vector<StabilizedWindow> windows;
};

/// Throws InputError where a file is missing or malformed.
[[nodiscard]] StabilizedRun load_stabilized(const std::filesystem::path& folder);

/// One window in pictures: bilinear counts of the same events.
struct WindowImages {
  ImageF raw;         ///< where they fired, without the lens
  ImageF stabilized;  ///< where the run put them
  ImageF truth;       ///< where the true rotation puts them; empty without ground truth
  std::size_t events = 0;
  std::size_t within_1px = 0;  ///< of the truth
};

/// The events of window `index`. The true position of an event of time t is
///   K R_(steady,camera) R(at)^T R(t) K^-1 u, R the true world_from_camera,
/// so that the heading of the run's world does not matter.
[[nodiscard]] WindowImages images_of(const StabilizedRun& run, std::size_t index,
                                     const Dataset& dataset);

/// Variance of an image's pixels: large where events of one edge fall on one line.
[[nodiscard]] double sharpness(const ImageF& image);

/// Means over the windows: sharpness.{raw,stabilized,truth}, and sharpness.fwl, stabilized / raw of each
/// window in which raw is not 0 (the flow warp loss of Stoffregen et al., ECCV 2020). And
/// stabilization.within_1px, the fraction of the events within a pixel of their true position.
[[nodiscard]] Metrics score_stabilization(const StabilizedRun& run, const Dataset& dataset);

}  // namespace saccade
