#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/trajectory.h"
#include "estimator/edges/dense_path.h"
#include "estimator/edges/edge_matches.h"
#include "estimator/edges/edge_view.h"
#include "estimator/edges/least_squares/cost_log.h"
#include "estimator/edges/least_squares/edge_bundle.h"
#include "estimator/edges/least_squares/path_information.h"
#include "estimator/edges/path/inertial_factors.h"
#include "estimator/edges/path/path_correction.h"

namespace saccade {

struct PathEdgeProblemOptions {
  double knot_spacing_s = 0.05;  ///< of the path's correction, which is slower than the motion
  int edges = 1500;              ///< of a view, at most, evenly chosen
  int all_edges = 100000;        ///< of all views: some seven million events, 2 to 3 GB
  Reobserving reobserving = Reobserving::kLater;
  int reobserved_views = 4;         ///< later (earlier) ones that observe an edge again, at most
  int reobserved_events = 10;       ///< of an edge in each of them, at most
  double correction_sigma_px = 30;  ///< of the correction from 0, as image motion
  double slope_walk_px = 30;        ///< random walk of the correction's slope within a second
  double given_sigma_px = 0.02;     ///< of the given poses, as image motion
  int iterations = 10;              ///< of Levenberg-Marquardt, at most
  BundleSolver solver = BundleSolver::kStructured;
};

/// What is known of a path beside its edges.
struct PathInput {
  std::vector<StampedPose> path;  ///< spans the events
  /// Poses that fix the position and, where there is more than one, the scale.
  std::vector<StampedPose> given;
  double typical_depth_m = 1;  ///< converts pixels to metres
  /// Edges that are known and stay where they are.
  std::span<const Landmark> landmarks;
};

/// Which part of a path and of its views is adjusted.
struct PathEdgePart {
  SplineKnots knots;           ///< of the correction
  std::size_t first_view = 0;  ///< edges of views before this one only observe others again
};

/// The sigma of a twist (v, w) whose parts move the image by `px`.
[[nodiscard]] Twist sigma_of_px(double px, const PinholeCamera& camera, double depth_m);

/// A camera's path every millisecond: the poses through a smooth spline.
[[nodiscard]] Trajectory smoothed_path(std::span<const StampedPose> path, double smoothing_s);

/// The bundle adjustment of a path's correction (path_correction.h) and of the edges of several
/// views along it, with the noise model of edge_noise.h, as an EdgeBundle. The given poses fix the
/// gauge. Deterministic for any number of threads.
class PathEdgeProblem {
 public:
  /// The unknowns of an edge (edge_residual.h) and, last, k [px]: how much farther across the edge
  /// each event of a polarity run (polarity_runs.h) lies than the one before. h, the ON/OFF shift,
  /// is of the polarity alone.
  using Unknowns = PathBundle::Unknowns;

  /// `views` are in order of time. They, `path` and `options` outlive the problem. `camera` is
  /// undistorted.
  PathEdgeProblem(const Trajectory& path, std::span<const EdgeView> views, const PathInput& input,
                  const PinholeCamera& camera, const PathEdgeProblemOptions& options);
  PathEdgeProblem(const Trajectory& path, std::span<const EdgeView> views, const PathInput& input,
                  const PathEdgePart& part, const PinholeCamera& camera,
                  const PathEdgeProblemOptions& options);

  /// What else is known of the first controls of the correction, six numbers each.
  void add_prior(std::unique_ptr<ceres::CostFunction> cost, std::size_t controls);

  /// The samples of an inertial sensor join in, each worth `1 / information_ratio` of what it would
  /// be beside independent events. Throws InputError where they do not fit the path.
  void add_inertial_sensor(const MountedImu& imu, bool is_metric, double interval_s,
                           double information_ratio);

  /// False: it has no solution. `each` is called after every iteration, if set.
  bool solve(CostLog& costs, const std::function<void()>& each = {});

  /// What the edges of these views say of the correction, from where it is now, whatever they are.
  [[nodiscard]] std::optional<PathInformation> information_of_views(std::size_t first,
                                                                    std::size_t last);

  /// As corrected.
  [[nodiscard]] Trajectory path() const { return correction_.applied(path_); }
  [[nodiscard]] const PathCorrection& correction() const { return correction_; }
  [[nodiscard]] PathBundle& bundle() { return bundle_; }
  [[nodiscard]] std::optional<InertialAlignment> inertial() const {
    return inertial_factors_ ? std::optional(inertial_factors_->found()) : std::nullopt;
  }

 private:
  struct PathEdge {
    EdgeOfView found;
    Unknowns unknowns;
  };

  [[nodiscard]] const FittedEdgel& found(const EdgeOfView& edge) const {
    return views_[edge.view].edges[edge.edge];
  }
  void choose_edges(std::size_t first_view);
  void add_edges(std::span<const Landmark> landmarks);
  [[nodiscard]] std::vector<PathBundle::Event> events_of(
      const PathEdge& edge, std::span<const EdgeOfView> reobservations) const;
  [[nodiscard]] PathBundle::Event event_of(const PathEdge& edge, const EdgeEvent& event,
                                           double sigma_px) const;
  void add_path_priors(const std::vector<StampedPose>& given);
  void add_prior(const Matrix6& root, const Twist& mean, const Eigen::Vector4d& weight,
                 std::size_t first);
  void add_slope_prior();

  const Trajectory& path_;
  std::span<const EdgeView> views_;
  const PathEdgeProblemOptions& options_;
  PinholeCamera camera_;
  double depth_m_;
  PathCorrection correction_;
  DensePath world_from_camera_;
  std::vector<Rigid3> world_from_view_, view_from_world_;
  std::vector<PathEdge> edges_;
  std::optional<InertialFactors> inertial_factors_;
  PathBundle bundle_;
};

}  // namespace saccade
