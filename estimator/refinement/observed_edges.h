#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/camera.h"
#include "core/rigid3.h"
#include "estimator/depth/rays/ray_depth.h"
#include "estimator/refinement/edge_residual.h"
#include "estimator/refinement/node_correction.h"
#include "estimator/run/view_windows.h"

namespace saccade {

/// An event of an edge between two nodes of a correction.
struct ChosenEvent {
  EdgeObservation observation;
  int node;      ///< the earlier
  double share;  ///< of the later
};

/// How many of an edge's events count between two nodes of a correction, at most, in pairs.
struct EventShares {
  int pairs = 1;        ///< >= 1
  int given_pairs = 1;  ///< >= 1, after nodes that are before `given_until_s`
  double given_until_s = 0;
};

/// The edges of a window with the events that speak for them.
class ObservedEdges {
 public:
  /// All but `camera`, which may have a lens, outlive it.
  ObservedEdges(const ViewWindow& window, const WindowEdgels& edges, const PinholeCamera& camera,
                const NodeCorrection& correction, const EventShares& shares);

  /// In order of time, evenly spread.
  [[nodiscard]] std::vector<ChosenEvent> of(const FittedEdgel& edge) const;
  /// Undistorted.
  [[nodiscard]] const PinholeCamera& camera() const { return undistorted_; }

 private:
  [[nodiscard]] ChosenEvent observed(const FittedEdgel& edge, double mean_step,
                                     std::uint32_t index) const;

  const ViewWindow& window_;
  const WindowEdgels& edges_;
  PinholeCamera camera_;
  PinholeCamera undistorted_;
  const NodeCorrection& correction_;
  Rigid3 view_from_world_;
  std::vector<std::uint8_t> steps_;  ///< of every event of the window
  /// The events between a node and the next one.
  struct NodeEvents {
    std::uint32_t end;  ///< index behind the last
    std::size_t most;   ///< count of an edge, at most
  };
  std::vector<NodeEvents> nodes_;  ///< of all but the last
};

}  // namespace saccade
