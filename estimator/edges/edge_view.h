#pragma once

#include <limits>
#include <span>
#include <vector>

#include "core/camera.h"
#include "estimator/depth/rays/ray_depth.h"
#include "estimator/run/view_windows.h"

namespace saccade {

/// An event of an edge: all of it that does not depend on the camera's path.
struct EdgeEvent {
  double t_s = 0;
  float ray_x = 0, ray_y = 0;  ///< of the undistorted camera, z = 1
  float polarity = 1;          ///< +1 or -1
  /// Its position in its polarity run above the mean of the edge's events; 0 where it is unknown.
  float run_offset = 0;
};

/// The edges that a window shows as of one view, each with some of its events.
struct EdgeView {
  double t_s = 0;                  ///< of the view
  double from_s = 0, until_s = 0;  ///< of the window's first and last event
  std::vector<FittedEdgel> edges;  ///< `first` and `last` are indices into `events`
  std::vector<EdgeEvent> events;   ///< of an edge in order of time

  [[nodiscard]] bool shares_events_with(const EdgeView& other) const {
    return from_s <= other.until_s && other.from_s <= until_s;
  }
  [[nodiscard]] std::span<const EdgeEvent> of(const FittedEdgel& edge) const {
    return std::span(events).subspan(edge.first, edge.last - edge.first);
  }
};

struct EdgeViewOptions {
  int events_per_edge = 30;         ///< at most, evenly in time
  int given_events_per_edge = 100;  ///< beside them, while poses are given
  double given_until_s = std::numeric_limits<double>::lowest();
};

/// The view of a window whose edges were found. `camera` may have a lens.
[[nodiscard]] EdgeView edge_view(const ViewWindow& window, const WindowEdgels& found,
                                 const PinholeCamera& camera, const EdgeViewOptions& options);

/// `most` of `count` indices, evenly.
[[nodiscard]] std::vector<std::size_t> evenly(std::size_t count, int most);

}  // namespace saccade
