#include "estimator/tracking/pose_output.h"

#include <algorithm>
#include <numbers>
#include <string>
#include <vector>

#include "core/io/ply_file.h"
#include "core/io/tables/csv_file.h"
#include "core/io/trajectory_file.h"

namespace saccade {
namespace {

/// Poses of one trajectory have increasing times; two frames of a burst may share theirs.
std::vector<StampedPose> stamped_poses(std::span<const TrackedPose> poses) {
  std::vector<StampedPose> stamped;
  for (const TrackedPose& pose : poses) {
    const double t_s = seconds_from_ns(pose.t_ns);
    if (pose.is_gap) continue;
    if (stamped.empty() || t_s > stamped.back().t_s)
      stamped.push_back({t_s, pose.world_from_camera});
  }
  return stamped;
}

std::string name_of(TrackStatus status) {
  switch (status) {
    case TrackStatus::kOk:
      return "ok";
    case TrackStatus::kLost:
      return "lost";
    case TrackStatus::kRelocalised:
      return "relocalised";
  }
  return {};
}

void write_poses_csv(const std::filesystem::path& file, std::span<const TrackedPose> poses) {
  CsvTable table({"t_s", "first_event_s", "last_event_s", "status", "inlier_ratio", "iterations",
                  "residual", "position_sigma_m", "rotation_sigma_deg", "probability", "explained",
                  "chance", "in_map", "edges_confirmed", "confirmed_if_wrong", "depth_m",
                  "tracker_lost"});
  for (const TrackedPose& p : poses)
    table.add({seconds_from_ns(p.t_ns), seconds_from_ns(p.first_ns), seconds_from_ns(p.last_ns),
               name_of(p.status), p.inlier_ratio, static_cast<long long>(p.iterations), p.residual,
               p.position_sigma_m, p.rotation_sigma_rad * 180 / std::numbers::pi, p.probability,
               p.evidence.explained, p.evidence.chance, p.evidence.in_map,
               p.evidence.edges_confirmed, p.evidence.confirmed_if_wrong, p.evidence.depth_m,
               static_cast<long long>(p.evidence.tracker_lost)});
  table.save(file);
}

}  // namespace

void write_poses(const std::filesystem::path& folder, std::span<const TrackedPose> poses) {
  write_tum_trajectory(folder / "trajectory.txt", stamped_poses(poses));
  write_poses_csv(folder / "poses.csv", poses);
}

void write_map(const std::filesystem::path& file, const MapPoints& map,
               const Rigid3& world_from_map) {
  PointCloud cloud;
  for (std::size_t i = 0; i < map.size(); ++i) {
    const Eigen::Vector3d point(map.x[i], map.y[i], map.z[i]);
    cloud.positions.emplace_back((world_from_map * point).cast<float>());
  }
  write_ply(file, cloud);
}

std::size_t count_lost(std::span<const TrackedPose> poses) {
  return static_cast<std::size_t>(
      std::count_if(poses.begin(), poses.end(),
                    [](const TrackedPose& p) { return p.status == TrackStatus::kLost; }));
}

}  // namespace saccade
