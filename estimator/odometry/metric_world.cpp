#include "estimator/odometry/metric_world.h"

#include <utility>

#include "core/check.h"
#include "core/config/config.h"
#include "core/io/files/atomic_file.h"
#include "core/median.h"
#include "estimator/run/run_writer.h"

namespace saccade {
namespace {

struct InertialRecord {
  int format_version = 1;
  InertialAlignment found;
  bool applied = false;
};

void describe(config::Fields& fields, InertialRecord& record) {
  using Status = InertialAlignment::Status;
  InertialAlignment& found = record.found;
  fields.value("format_version", record.format_version, "layout of this file");
  fields.choice("status", found.status,
                {{"ok", Status::kOk},
                 {"no_readings", Status::kNoSamples},
                 {"even_motion", Status::kUnobservableScale},
                 {"disagrees", Status::kInconsistent}},
                "whether the readings say what the scale is");
  fields.value("applied", record.applied, "the run is in metres, its world's z axis points up");
  fields.value("scale", found.scale, "metres in the unit that the path was found in");
  fields.value("scale_sigma", found.scale_sigma, "its deviation, relative");
  fields.value("gravity", found.gravity, "in the world that the path was found in [m/s^2]");
  fields.value("tilt_sigma_rad", found.tilt_sigma_rad, "deviation of its direction [rad]");
  fields.value("gyro_bias", found.bias.gyro, "in the camera's axes [rad/s]");
  fields.value("accel_bias", found.bias.accel, "in the camera's axes [m/s^2]");
  fields.value("time_offset_s", found.time_offset_s,
               "a reading stamped t was taken when the events' clock showed t + offset");
  fields.value("residual", found.residual, "of the path's intervals, over the expected deviation");
}

}  // namespace

InertialAlignment align_odometry(std::span<const TrackedPose> poses,
                                 std::span<const Keyframe> keyframes, const MountedImu& imu) {
  std::vector<StampedPose> path;
  for (const TrackedPose& pose : poses)
    if (pose.status == TrackStatus::kOk)
      if (const double t_s = seconds_from_ns(pose.t_ns); path.empty() || t_s > path.back().t_s)
        path.push_back({t_s, pose.world_from_camera});
  if (path.size() < 2 || keyframes.empty()) return {};
  std::vector<double> depths;
  for (const Keyframe& keyframe : keyframes) depths.push_back(keyframe.typical_depth_m);
  return align_inertially(Trajectory(std::move(path)), imu, median(std::move(depths)));
}

Rigid3 in_metric_world(const InertialAlignment& found, const Rigid3& world_from_camera) {
  const Eigen::Quaterniond gravity_alignment = found.gravity_alignment();
  return {gravity_alignment * world_from_camera.rotation(),
          gravity_alignment * (found.scale * world_from_camera.translation())};
}

void transform_to_metric_world(const InertialAlignment& found, std::span<TrackedPose> poses,
                               std::span<Keyframe> keyframes,
                               std::span<StampedCovariance> covariances) {
  SACCADE_CHECK(found.status == InertialAlignment::Status::kOk);
  for (TrackedPose& pose : poses) {
    pose.world_from_camera = in_metric_world(found, pose.world_from_camera);
    pose.position_sigma_m *= found.scale;
  }
  // Of (v, w) in the camera's axes: v alone is a length.
  for (StampedCovariance& one : covariances) {
    one.covariance.topRows<3>() *= found.scale;
    one.covariance.leftCols<3>() *= found.scale;
  }
  const auto scale = static_cast<float>(found.scale);
  const Eigen::Matrix3f metres = scale * found.gravity_alignment().toRotationMatrix().cast<float>();
  for (Keyframe& keyframe : keyframes) {
    keyframe.world_from_camera = in_metric_world(found, keyframe.world_from_camera);
    keyframe.typical_depth_m *= found.scale;
    for (EdgePoint& point : keyframe.depth.points) {
      point.inverse_depth /= scale;
      point.sigma /= scale;
    }
    MapPoints& edges = keyframe.edges;
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const Eigen::Vector3f point = metres * Eigen::Vector3f(edges.x[i], edges.y[i], edges.z[i]);
      edges.x[i] = point.x();
      edges.y[i] = point.y();
      edges.z[i] = point.z();
    }
  }
}

void write_inertial_alignment(const std::filesystem::path& file, const InertialAlignment& found,
                              bool applied) {
  write_atomically(file, config::print(InertialRecord{1, found, applied}));
}

}  // namespace saccade
