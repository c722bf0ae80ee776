#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/rigid3.h"
#include "estimator/depth/rays/event_assignment.h"
#include "estimator/depth/rays/ray_depth.h"
#include "estimator/refinement/landmarks.h"
#include "estimator/run/view_windows.h"

namespace saccade {

/// The edge as another view sees it; nullopt for behind it. `camera` is undistorted.
[[nodiscard]] std::optional<FittedEdgel> seen_by(const Rigid3& other_from_view, FittedEdgel fitted,
                                                 const PinholeCamera& camera);

/// The edges of a view, looked up from another view: which of them lies on an edge there. On it is
/// one within 2 px of its place, at its depth but for a tenth, and along it but for 15 degrees,
/// brighter on the same side.
class EdgeMatcher {
 public:
  /// `other_from_view`: from where the edges are to where they are looked up. They must outlive the
  /// matcher; `camera` is undistorted.
  EdgeMatcher(std::span<const FittedEdgel> edges, const Rigid3& other_from_view,
              const PinholeCamera& camera);

  /// Its number; nullopt for none.
  [[nodiscard]] std::optional<std::size_t> on(const Edgel& edge) const;

 private:
  std::span<const FittedEdgel> edges_;
  Rigid3 other_from_view_;
  PinholeCamera camera_;
  SeenLandmarks places_;
};

/// An edge that a keyframe's window shows.
struct KeyframeEdge {
  std::size_t keyframe;
  std::size_t edge;  ///< in the keyframe's WindowEdgels
};

/// Of each of these edges what later keyframes see of it that are at least `apart_s` away, in order
/// of time. `windows` are in order of time, `found` are their edges; `edges` are in order of their
/// keyframes.
[[nodiscard]] std::vector<std::vector<KeyframeEdge>> seen_again(std::span<const KeyframeEdge> edges,
                                                                std::span<const ViewWindow> windows,
                                                                std::span<const WindowEdgels> found,
                                                                double apart_s,
                                                                const PinholeCamera& camera);

}  // namespace saccade
