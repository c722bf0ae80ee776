#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/io/dataset/dataset.h"

namespace saccade {

/// A pixel of a true frame where the log intensity changes, as a short line in the static world.
struct TrueEdge {
  Eigen::Vector3d point;      ///< in the world [m]
  Eigen::Vector3d along;      ///< what is seen one pixel further along the edge, at the same depth
  Eigen::Vector3d per_log_z;  ///< d point / d ln z, from the camera's centre to the point [m]
  Eigen::Vector3d per_px;     ///< d point / d pixel across the edge [m/px]
  double strength = 0;        ///< |grad L| [1/px]
  double pixels = 1;          ///< how many edge pixels of its frame it stands for
  std::size_t frame = 0;      ///< index into TrueEdges::frames
};

/// A frame with true depth and pose.
struct TrueFrame {
  double t_s = 0;
  ImageF depth;  ///< z [m] on the sensor with its lens, 0 = unknown
  Rigid3 world_from_camera;
};

/// A sample of the edges that a recording's frames show.
struct TrueEdges {
  /// An edge is drawn over about two pixels, by the blur of a lens and the pixels' own area: this is
  /// how far its gradient reaches [px].
  static constexpr double kWidthPx = 2;

  std::vector<TrueFrame> frames;  ///< in order of time
  std::vector<TrueEdge> edges;

  /// Whether frame `index` shows the point, or something in front of it, or another part of the world.
  enum class Sight { kSeen, kHidden, kOutside };
  [[nodiscard]] Sight sight(const PinholeCamera& camera, std::size_t index,
                            const Eigen::Vector3d& point) const;
  /// Where the sensor sees a point of the camera's frame, without the lens [px]; nullopt where it does
  /// not. A lens model that folds over far outside of the image shows nothing there.
  [[nodiscard]] static std::optional<Eigen::Vector2d> pixel_of(const PinholeCamera& camera,
                                                               const Eigen::Vector3d& in_camera);
  /// The frame nearest in time; there is one (contract).
  [[nodiscard]] std::size_t nearest_frame(double t_s) const;
};

/// Of at most 60 frames spread over the recording, every n-th pixel whose |grad L| is at least
/// `least_strength` [1/px] and whose depth is known. No frames where the dataset lacks frames, depth at
/// their times, or poses.
[[nodiscard]] TrueEdges find_true_edges(const Dataset& dataset, double least_strength);

}  // namespace saccade
