#include "simulator/record_groundtruth.h"

#include <utility>
#include <vector>

#include "core/io/imu_file.h"
#include "core/io/trajectory_file.h"
#include "simulator/scene/moving_object.h"
#include "simulator/sensor/sample_times.h"

namespace saccade {

double record_groundtruth(const CameraRecording& recording) {
  const TimeNs end = ns_from_seconds(recording.duration_s());
  std::vector<StampedPose> poses;
  std::vector<StampedTwist> twists;
  std::vector<ObjectPose> objects;
  for (const TimeNs t : merge_times({end}, sample_times(recording.config.groundtruth.pose_rate_hz,
                                                        recording.duration_s()))) {
    const double t_s = seconds_from_ns(t);
    const SplineState state = recording.world_from_camera.state(t_s);
    const Rigid3& pose = state.world_from_body;
    poses.push_back({t_s, pose});
    twists.push_back({t_s, pose.rotation().conjugate() * state.velocity_in_world,
                      state.angular_velocity_in_body});
    for (const MovingObject& object : recording.scene.moving_objects())
      if (object.has_trajectory()) objects.push_back({t_s, object.object(), object.pose(t_s)});
  }
  recording.writer.write_groundtruth(poses);
  write_twists(recording.writer.folder() / "twist.txt", twists);
  if (!objects.empty()) write_object_poses(recording.writer.folder() / "objects.txt", objects);
  return Trajectory(std::move(poses)).path_length();
}

void record_imu(const CameraRecording& recording) {
  const ImuOptions& options = recording.config.imu;
  if (options.rate_hz <= 0) return;
  const ImuRecording imu = record_imu(recording.world_from_camera, options,
                                      recording.config.gravity_m_s2, recording.config.seed);
  recording.writer.write_imu(imu.readings);
  write_imu_truth(recording.writer.folder() / "imu_groundtruth.txt", imu.truth);
  write_imu_yaml(recording.writer.folder() / "imu.yaml", options.calibration());
}

}  // namespace saccade
