#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/event.h"
#include "core/trajectory.h"
#include "estimator/depth/depth_config.h"
#include "estimator/edges/window/window_adjustment.h"
#include "estimator/odometry/keyframe.h"
#include "estimator/reconstruction/reconstruction_config.h"

namespace saccade {

/// How a keyframe is made from events and poses.
struct MappingOptions {
  enum class Edges { kGradient, kDepth };
  enum class View { kMiddle, kEnd };

  int events = 200000;      ///< N_map: at most so many, the newest
  double duration_s = 0.4;  ///< ... and of at most so long
  /// ... and of no time in which the view was turned by more than this part of its angle from where
  /// it is at the end; 0: of any. What a fast turn has left is of no use for what comes.
  double turn = 0;
  int depth_events = 1000000000;  ///< of kDepth: depth is found from about so many of them
  View view = View::kEnd;         ///< where in its events the view lies
  Edges edges = Edges::kDepth;    ///< steep pixels of the reconstruction, or the points with depth
  bool image = true;              ///< made after the last event, where the edges do not need it
  double max_sigma = 0.05;        ///< of a point's inverse depth that becomes an edge, relative
  /// Of kDepth: where it is not 0, parts of the view with few edges are tracked by those of up to 9
  /// times the sigma, too (keep_certain()): what hardly moves, as the walls behind a table, tells
  /// how the camera turns, and needs no better depth for that. Where all of them are fewer than this,
  /// edges whose depth cannot be told are tracked, too, at the typical depth where it is known.
  /// Renewed depths are the certain ones alone.
  int min_edges = 0;
  /// Larger sigmas count only where the view has few points of this one, relative; 0: everywhere.
  double certain_sigma = 0;
  double smoothing_s = 0;  ///< spacing of the knots of a spline through the poses; 0: as tracked
  /// Rounds of finding edges and adjusting them together with the poses; 0: the poses are taken as
  /// they are. Of DepthConfig's method rays.
  int adjust_rounds = 0;
  WindowAdjustmentOptions adjustment;
  MapOptions steep;  ///< of kGradient
  DepthConfig depth;
  /// With contrasts of 0.2: they matter for the image alone, and nothing comes from the dataset.
  ReconstructionConfig reconstruction = with_contrast(0.2);

 private:
  [[nodiscard]] static ReconstructionConfig with_contrast(double contrast) {
    ReconstructionConfig config;
    config.contrast_on = config.contrast_off = contrast;
    return config;
  }
};

/// The camera's path as far as it is known, from given poses or estimated ones.
struct PathEstimate {
  Trajectory poses;
  double fixed_until_s = 0;               ///< poses until then do not change any more
  double given_until_s = kNoGivenPoses;   ///< those until then were given: they fix the scale
  std::optional<double> typical_depth_m;  ///< of the scene; nullopt: a space sweep finds it
  std::vector<Landmark> landmarks;        ///< edges known from events before those of the window
  std::vector<Landmark> settled;          ///< edges of keyframes that do not change any more
};

/// The edges of a keyframe before their depths are fused, with the events that they were found in.
struct KeyframeEdges {
  std::vector<Event> events;
  WindowEdgels edges;
  MappingOptions options;  ///< by which they were found
};

/// A keyframe and the poses that it is consistent with.
struct Mapping {
  Keyframe keyframe;
  std::vector<StampedPose> poses;  ///< of its events, adjusted; in order of time
  /// Transforms a pose at its last event, and those after it, as the adjustment did.
  Rigid3 world_from_before;
  std::optional<KeyframeEdges> edges;  ///< where poses and edges were adjusted together
};

/// Mapping (thesis chapter 7): depth, then image of the newest events with known poses. Thread-safe
/// and deterministic.
class Mapper {
 public:
  static constexpr std::size_t kMinEdges = 50;  ///< of a keyframe: fewer track nothing

  /// `camera` with its lens.
  Mapper(const MappingOptions& options, const PinholeCamera& camera);

  /// A keyframe from the newest of `events`, none of them beyond the poses.
  [[nodiscard]] Mapping map(std::span<const Event> events, const PathEstimate& path) const;

  /// Depth and edges of a new keyframe on a better path, its events belonging to the edges that
  /// they belonged to before.
  void refit(const Trajectory& path, const PathEstimate& estimate, Mapping& mapping) const;

  /// Depth and edges of a keyframe anew, by better poses; `events` contain its own.
  /// Of DepthConfig's method rays and Edges::kDepth.
  void renew(std::span<const Event> events, const Trajectory& poses, Keyframe& keyframe) const;

  /// The depth that the edges of the newest events have in common, where hardly any has one that can
  /// be told by itself: the median of what their events say beside the assumption of `assumed_m`, by
  /// their information, which counts up to twice that of the assumption. nullopt where all together
  /// say it less well than to a tenth.
  [[nodiscard]] std::optional<double> common_depth(std::span<const Event> events,
                                                   const PathEstimate& path,
                                                   double assumed_m) const;

  [[nodiscard]] RayDepth rays() const;

  /// The image of a keyframe that was tracked without one; `events` contain its own.
  void add_image(std::span<const Event> events, const Trajectory& poses, Keyframe& keyframe) const;

 private:
  [[nodiscard]] Mapping map_once(std::span<const Event> events, const PathEstimate& path) const;
  [[nodiscard]] std::span<const Event> newest(std::span<const Event> events,
                                              const Trajectory& path) const;
  [[nodiscard]] Trajectory smoothed(const Trajectory& poses, std::span<const Event> events) const;
  [[nodiscard]] double sweep_depth(const ViewWindow& window) const;
  /// Adjusts `path`, which the window points to; the edges that it was adjusted by, if it was.
  [[nodiscard]] std::optional<WindowEdgels> adjust_path(ViewWindow& window, Trajectory& path,
                                                        const PathEstimate& estimate,
                                                        double typical_depth_m) const;
  [[nodiscard]] ImageF dense_depth(const Keyframe& keyframe) const;
  void reconstruct(const ViewWindow& window, const ImageF& depth, Keyframe& keyframe) const;
  [[nodiscard]] DepthResult certain(DepthResult depth) const;
  void add_steep_pixels(const ImageF& depth, Keyframe& keyframe) const;
  void add_points(Keyframe& keyframe) const;
  /// Those whose depth is assumed are tracked, but are no depth of the keyframe.
  void add_assumed_points(const WindowEdgels& edges, Keyframe& keyframe) const;

  MappingOptions options_;
  PinholeCamera camera_;
};

}  // namespace saccade
