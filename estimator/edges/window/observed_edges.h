#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/camera.h"
#include "core/rigid3.h"
#include "estimator/depth/rays/ray_depth.h"
#include "estimator/edges/dense_path.h"
#include "estimator/edges/edge_residual.h"
#include "estimator/edges/window/node_correction.h"
#include "estimator/run/view_windows.h"

namespace saccade {

/// An event of an edge between two nodes of a path's correction.
struct ObservedEvent {
  EdgeObservation observation;
  int node = 0;         ///< the earlier
  double fraction = 0;  ///< s of the later, 0..1
};

/// The edges of a window with the events that are their observations.
class ObservedEdges {
 public:
  /// `max_pairs`: the most pairs of an edge's events between two nodes of the correction, by the
  /// time of the earlier. All but `camera`, which may have a lens, outlive it.
  ObservedEdges(const ViewWindow& window, const WindowEdgels& edges, const PinholeCamera& camera,
                const NodeCorrection& correction, const std::function<int(double)>& max_pairs);

  /// In order of time, evenly spread.
  [[nodiscard]] std::vector<ObservedEvent> of(const FittedEdgel& edge) const;
  /// Undistorted.
  [[nodiscard]] const PinholeCamera& camera() const { return undistorted_; }

 private:
  [[nodiscard]] ObservedEvent observed(const FittedEdgel& edge, double mean_position,
                                       std::uint32_t index) const;

  const ViewWindow& window_;
  const WindowEdgels& edges_;
  PinholeCamera camera_;
  PinholeCamera undistorted_;
  const NodeCorrection& correction_;
  DensePath view_from_camera_;
  std::vector<std::uint8_t> run_positions_;  ///< of every event of the window
  /// The events between a node and the next one.
  struct NodeEvents {
    std::uint32_t end;       ///< index behind the last
    std::size_t max_events;  ///< of an edge
  };
  std::vector<NodeEvents> nodes_;  ///< of all but the last
};

}  // namespace saccade
