#include "eval/information/observations.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/median.h"

namespace saccade {
namespace {

constexpr double kNodeMotionPx = 2;
/// Six unknowns each: the dense system of 200 takes a second.
constexpr std::size_t kMostNodes = 200;
constexpr double kEdgeWidthPx = TrueEdges::kWidthPx;
/// What blur, noise and the pixels' area leave of a place at best, as accurate methods show: depth
/// that errs by 0.1 % where edges move by 50 px.
constexpr double kLeastSigmaPx = 0.1;
/// Enough for a median to a tenth of itself.
constexpr std::size_t kMotionSamples = 200;

/// What one event says of where an edge of `strength` [1/px] is, across it [px]: it is anywhere
/// between this event and the next, which are a threshold apart.
double sigma_px(double contrast, double strength) {
  return std::max(contrast / strength / std::sqrt(12.0), kLeastSigmaPx);
}

std::optional<Eigen::Vector2d> pixel_of(const PinholeCamera& camera,
                                        const Rigid3& world_from_camera,
                                        const Eigen::Vector3d& point) {
  return TrueEdges::pixel_of(camera, world_from_camera.inverse() * point);
}

/// Median motion of what both poses see [px]; nullopt where they see nothing in common.
std::optional<double> motion_between(const Rigid3& before, const Rigid3& after,
                                     const std::vector<Eigen::Vector3d>& points,
                                     const PinholeCamera& camera) {
  std::vector<double> motions;
  for (const Eigen::Vector3d& point : points) {
    const auto from = pixel_of(camera, before, point);
    const auto to = pixel_of(camera, after, point);
    if (from && to) motions.push_back((*to - *from).norm());
  }
  if (motions.empty()) return std::nullopt;
  return median(std::move(motions));
}

/// How far the view moves where all is as far away as `depth_m` [px].
double motion_of_poses(const Rigid3& before, const Rigid3& after, double f, double depth_m) {
  return f * (angle_between(before.rotation(), after.rotation()) +
              (after.translation() - before.translation()).norm() / depth_m);
}

/// Some points of the frame nearest to `t_s`; none where it shows no edge.
std::vector<Eigen::Vector3d> points_at(double t_s, const TrueEdges& edges) {
  const std::size_t frame = edges.nearest_frame(t_s);
  std::vector<Eigen::Vector3d> points;
  for (const TrueEdge& edge : edges.edges)
    if (edge.frame == frame) points.push_back(edge.point);
  const std::size_t step = points.size() / kMotionSamples + 1;
  std::vector<Eigen::Vector3d> some;
  for (std::size_t i = 0; i < points.size(); i += step) some.push_back(points[i]);
  return some;
}

std::vector<PathNode> thinned(const std::vector<PathNode>& nodes) {
  if (nodes.size() <= kMostNodes) return nodes;
  std::vector<PathNode> fewer;
  std::size_t last = 0;
  for (std::size_t i = 0; i < kMostNodes; ++i) {
    const std::size_t next = i * (nodes.size() - 1) / (kMostNodes - 1);
    PathNode node = nodes[next];
    for (std::size_t k = last + 1; k < next; ++k) node.motion_px += nodes[k].motion_px;
    last = next;
    fewer.push_back(node);
  }
  return fewer;
}

}  // namespace

std::vector<PathNode> path_nodes(const Trajectory& path, const TrueEdges& edges,
                                 const PinholeCamera& camera, double depth_m) {
  const auto poses = path.poses();
  std::vector<PathNode> nodes{{poses.front().t_s, poses.front().world_from_camera}};
  std::vector<Eigen::Vector3d> points = points_at(poses.front().t_s, edges);
  for (const StampedPose& pose : poses.subspan(1)) {
    const Rigid3& before = nodes.back().world_from_camera;
    const double motion_px =
        motion_between(before, pose.world_from_camera, points, camera)
            .value_or(motion_of_poses(before, pose.world_from_camera, camera.fx, depth_m));
    const bool is_end = nodes.size() == 1 && pose.t_s == path.end_s();
    if (motion_px < kNodeMotionPx && !is_end) continue;
    nodes.push_back({pose.t_s, pose.world_from_camera, motion_px});
    points = points_at(pose.t_s, edges);
  }
  return thinned(nodes);
}

LineObservation linearise(const PinholeCamera& camera, const TrueEdge& edge,
                          const Rigid3& world_from_camera) {
  const Rigid3 camera_from_world = world_from_camera.inverse();
  const Eigen::Vector3d point = camera_from_world * edge.point;
  const Eigen::Vector2d line =
      (camera.project(camera_from_world * edge.along) - camera.project(point)).normalized();
  const Eigen::RowVector3d by_point =
      Eigen::RowVector2d(-line.y(), line.x()) * camera.project_jacobian(point);
  Eigen::Matrix<double, 3, 2> point_by_edge;
  point_by_edge << edge.per_log_z, edge.per_px;
  LineObservation observation;
  observation.by_pose = -by_point * point_jacobian(point);
  observation.by_edge = by_point * camera_from_world.rotation_matrix() * point_by_edge;
  return observation;
}

std::vector<LineObservation> observe(const PinholeCamera& camera, const TrueEdges& edges,
                                     const TrueEdge& edge, const std::vector<PathNode>& nodes,
                                     double contrast) {
  const PinholeCamera view = camera.undistorted();
  std::vector<LineObservation> observations;
  std::optional<Eigen::Vector2d> fired_at;  // or where it came into view
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Rigid3& pose = nodes[i].world_from_camera;
    const auto pixel = pixel_of(camera, pose, edge.point);
    if (!pixel || edges.sight(camera, edges.nearest_frame(nodes[i].t_s), edge.point) ==
                      TrueEdges::Sight::kHidden) {
      fired_at.reset();
      continue;
    }
    if (!fired_at) {
      fired_at = pixel;
      continue;
    }
    const Eigen::Vector2d line = view.project(pose.inverse() * edge.along) - *pixel;
    const Eigen::Vector2d normal = Eigen::Vector2d(-line.y(), line.x()).normalized();
    const double moved_px = std::abs(normal.dot(*pixel - *fired_at));
    if (edge.strength * std::min(moved_px, kEdgeWidthPx) < contrast) continue;
    LineObservation observation = linearise(view, edge, pose);
    observation.node = i;
    // Each width of the edge that it moves by says where it is anew; the events of one width share
    // what is wrong about it.
    const double sigma = sigma_px(contrast, edge.strength);
    observation.weight = std::max(1.0, moved_px / kEdgeWidthPx) / (sigma * sigma);
    observations.push_back(observation);
    fired_at = pixel;
  }
  return observations;
}

}  // namespace saccade
