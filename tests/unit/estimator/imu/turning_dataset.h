#pragma once

#include <filesystem>
#include <vector>

#include "core/imu_sample.h"
#include "core/io/imu_file.h"
#include "core/io/trajectory_file.h"
#include "core/rigid3.h"
#include "tests/support/fake_run.h"
#include "tests/support/planar_world.h"

namespace saccade::testing {

/// The camera of write_corner_dataset() in a world whose z axis points up, as its y axis does not.
inline Eigen::Quaterniond up_from_corner() { return so3_exp({-1.5707963267948966, 0, 0}); }

/// Angular velocity of corner_motion(), in camera axes [rad/s].
inline Eigen::Vector3d corner_rate(double t_s) {
  constexpr double kDelta_s = 1e-5;
  return so3_log(corner_motion(t_s - kDelta_s).rotation().conjugate() *
                 corner_motion(t_s + kDelta_s).rotation()) /
         (2 * kDelta_s);
}

/// write_corner_dataset() with a perfect inertial sensor in the camera's axes that feels gravity
/// alone, and the truth of its turning.
inline void write_turning_dataset(const std::filesystem::path& folder, double duration_s,
                                  int width) {
  write_corner_dataset(folder, "corner", duration_s, width);
  std::vector<ImuSample> samples;
  std::vector<StampedTwist> twists;
  for (int i = 0; i <= static_cast<int>(1000 * duration_s); ++i) {
    const double t_s = 1e-3 * i;
    ImuSample sample;
    sample.t_ns = ns_from_seconds(t_s);
    sample.angular_velocity = corner_rate(t_s);
    sample.specific_force = (up_from_corner() * corner_motion(t_s).rotation()).conjugate() *
                            Eigen::Vector3d(0, 0, 9.81);
    samples.push_back(sample);
    twists.push_back({t_s, Eigen::Vector3d::Zero(), sample.angular_velocity});
  }
  write_imu(folder / "imu.txt", samples);
  write_twists(folder / "twist.txt", twists);
}

}  // namespace saccade::testing
