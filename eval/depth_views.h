#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "core/io/dataset/dataset.h"
#include "core/rigid3.h"
#include "eval/metrics/depth_metrics.h"
#include "eval/metrics/metrics.h"
#include "eval/metrics/plane_fit.h"
#include "eval/run_folder.h"

namespace saccade {

/// What an estimate claims in one view.
struct EstimatedView {
  double t_s = 0;
  Rigid3 world_from_camera;  ///< as the estimate has it
  std::vector<DepthPoint> points;
};

/// The views of views.yaml in `folder` that have depth: their points from cloud.ply where it states
/// view, pixel and depth, else the pixels of their depth maps. Empty without views.yaml.
[[nodiscard]] std::vector<EstimatedView> load_depth_views(const std::filesystem::path& folder);

/// Those of a run, its world as large as the truth's where its own scale is free
/// (TrajectoryScoreInput::freedom), by the dataset's mean depth or the one given; nullopt: unknown.
[[nodiscard]] std::vector<EstimatedView> load_depth_views(const RunFolder& run,
                                                          const Dataset& dataset);
[[nodiscard]] std::vector<EstimatedView> load_depth_views(
    const RunFolder& run, const Dataset& dataset, const std::optional<double>& mean_depth_m);

/// One view from a depth map (EXR: Z or the only channel [m], variance [m^2] where there is one; 0
/// = unknown; undistorted) at `t_s`, from the true pose.
[[nodiscard]] EstimatedView load_depth_map(const std::filesystem::path& file,
                                           const Dataset& dataset, double t_s);

/// One view from a point cloud in the world (PLY), as it projects into the camera at its true pose
/// at `t_s`: points before it and within the image. What stands in front of a point is not tested.
[[nodiscard]] EstimatedView load_cloud(const std::filesystem::path& file, const Dataset& dataset,
                                       double t_s);

/// The errors of every view; none, but the number of points, where the truth is unknown. They are
/// taken in the camera's frame against the
/// truth at the view's time from the TRUE pose, so that an error of the pose in the world does not
/// count.
[[nodiscard]] std::vector<DepthErrors> compare_views(const std::vector<EstimatedView>& views,
                                                     const Dataset& dataset);

/// All points in the world.
[[nodiscard]] std::vector<Eigen::Vector3d> points_in_world(const std::vector<EstimatedView>& views,
                                                           const PinholeCamera& camera);

/// The six planes that most points of all views lie on, within 1 % of the median depth.
[[nodiscard]] std::vector<FittedPlane> planes_of(const std::vector<EstimatedView>& views,
                                                 const PinholeCamera& camera);

/// set_depth_scores() and depth.two_planes.{angle_deg,share}: the angle between the two planes that
/// most points lie on, and the fraction of the points on either.
[[nodiscard]] Metrics score_depth(const std::vector<EstimatedView>& views,
                                  const std::vector<DepthErrors>& errors,
                                  const PinholeCamera& camera);

/// One row per view.
void write_depth_views_csv(const std::filesystem::path& file,
                           const std::vector<DepthErrors>& views);

}  // namespace saccade
