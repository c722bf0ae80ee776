#include "simulator/record_groundtruth.h"

#include <utility>
#include <vector>

#include "core/io/imu_file.h"
#include "core/io/trajectory_file.h"
#include "simulator/scene/moving_object.h"
#include "simulator/sensor/sample_times.h"

namespace saccade {

double record_groundtruth(const Take& take) {
  const TimeNs end = ns_from_seconds(take.duration_s());
  std::vector<StampedPose> poses;
  std::vector<StampedTwist> twists;
  std::vector<ObjectPose> objects;
  for (const TimeNs t :
       merge_times({end}, sample_times(take.config.groundtruth.pose_rate_hz, take.duration_s()))) {
    const double t_s = seconds_from_ns(t);
    const SplineState state = take.world_from_camera.state(t_s);
    const Rigid3& pose = state.world_from_body;
    poses.push_back({t_s, pose});
    twists.push_back({t_s, pose.rotation().conjugate() * state.velocity_in_world,
                      state.angular_velocity_in_body});
    for (const MovingObject& object : take.scene.moving_objects())
      objects.push_back({t_s, object.object(), object.pose(t_s)});
  }
  take.writer.write_groundtruth(poses);
  write_twists(take.writer.folder() / "twist.txt", twists);
  if (!objects.empty()) write_object_poses(take.writer.folder() / "objects.txt", objects);
  return Trajectory(std::move(poses)).path_length();
}

void record_imu(const Take& take) {
  const ImuOptions& options = take.config.imu;
  if (options.rate_hz <= 0) return;
  const ImuRecording imu =
      record_imu(take.world_from_camera, options, take.config.gravity_m_s2, take.config.seed);
  take.writer.write_imu(imu.readings);
  write_imu_truth(take.writer.folder() / "imu_groundtruth.txt", imu.truth);
  write_imu_yaml(take.writer.folder() / "imu.yaml", options.calibration());
}

}  // namespace saccade
