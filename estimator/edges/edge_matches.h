#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/rigid3.h"
#include "estimator/depth/rays/event_assignment.h"
#include "estimator/edges/edge_view.h"
#include "estimator/edges/landmarks.h"

namespace saccade {

/// The edge in another view; nullopt for behind it. `camera` is undistorted.
[[nodiscard]] std::optional<FittedEdgel> transformed(const Rigid3& other_from_view,
                                                     FittedEdgel fitted,
                                                     const PinholeCamera& camera);

/// Data association of edges between two views: which edge of the other view is an edge of this
/// one. The match lies within 2 px of the reprojection, within a tenth of the inverse depth and
/// within 15 degrees of the direction, and is brighter on the same side.
class EdgeMatcher {
 public:
  /// `other_from_view`: from the view of `edges` to that of the edges that are matched. `edges`
  /// outlive the matcher; `camera` is undistorted.
  EdgeMatcher(std::span<const FittedEdgel> edges, const Rigid3& other_from_view,
              const PinholeCamera& camera);

  /// The index of the edge's match; nullopt for none.
  [[nodiscard]] std::optional<std::size_t> match(const Edgel& edge) const;

 private:
  std::span<const FittedEdgel> edges_;
  Rigid3 other_from_view_;
  PinholeCamera camera_;
  ProjectedLandmarks landmarks_;
};

/// An edge of one of several views.
struct EdgeOfView {
  std::size_t view;
  std::size_t edge;  ///< in the view's EdgeView
};

/// Which of two views observes the edges of the other again.
enum class Reobserving { kLater, kEarlier };

/// Observations of each of these edges by later (earlier) views that share no events with its own,
/// in order of time. `views` are in order of time, with their poses on the camera's path; `edges`
/// are in order of their views.
[[nodiscard]] std::vector<std::vector<EdgeOfView>> reobservations(
    std::span<const EdgeOfView> edges, std::span<const EdgeView> views,
    std::span<const Rigid3> world_from_view, Reobserving which, const PinholeCamera& camera);

}  // namespace saccade
