#pragma once

// A run of odometry before the corner of a room: the recording, its truth and configurations.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/config/config.h"
#include "core/io/trajectory_file.h"
#include "estimator/odometry/odometry_config.h"
#include "estimator/odometry/odometry_module.h"
#include "tests/support/command.h"
#include "tests/support/planar_world.h"
#include "tests/support/recording.h"
#include "tests/support/shared_folder.h"
#include "tests/unit/estimator/run_request.h"

namespace saccade::testing {

constexpr double kEnd_s = 0.5;
constexpr double kDepth_m = 2.2;

/// Sideways with a turn, seen by a small camera in front of a corner.
inline Rigid3 glide(double t_s) {
  return {so3_exp({0.1 * t_s, -0.25 * t_s, 0.3 * t_s}),
          {0.8 * t_s, 0.1 * std::sin(6 * t_s), 0.1 * t_s}};
}

/// The same at constant velocity: without given poses the events of a small camera do not tell a
/// velocity that changes from a rotation.
inline Rigid3 steady_glide(double t_s) {
  return {so3_exp({0.1 * t_s, -0.25 * t_s, 0.3 * t_s}), {1.2 * t_s, 0.3 * t_s, 0.1 * t_s}};
}

inline std::vector<StampedPose> poses_until(double end_s, const Motion& motion = glide) {
  std::vector<StampedPose> poses;
  for (int i = 0; i * 1e-3 <= end_s + 1e-9; ++i) poses.push_back({i * 1e-3, motion(i * 1e-3)});
  return poses;
}

inline void write_poses_until(const std::filesystem::path& folder, double end_s) {
  write_tum_trajectory(folder / "groundtruth.txt", poses_until(end_s));
}

/// That a run's poses are true to 1.5 % of the depth, of 0.35 m and 0.16 rad that the camera moved.
inline void expect_glide(const std::filesystem::path& run) {
  double most_m = 0, most_rad = 0;
  const Trajectory found = read_trajectory(run / "trajectory.txt");
  for (const StampedPose& pose : found.poses()) {
    const Rigid3 error = glide(pose.t_s).inverse() * pose.world_from_camera;
    most_m = std::max(most_m, error.translation().norm());
    most_rad = std::max(most_rad, so3_log(error.rotation()).norm());
  }
  EXPECT_LT(most_m, 0.015 * kDepth_m);
  EXPECT_LT(most_rad, 0.015);
}

constexpr const char* kQuick = R"(
start: {truth_s: 0.2, truth_fraction: 0.4}
keyframe: {distance: 0.05, active: 3}
mapping: {duration_s: 0.3, min_edges: 0, image: false}
adjustment: {rounds: 0, edges: 500}
tracking: {event_map_ratio: 0.2}
)";

inline OdometryConfig quick() {
  return config::read<OdometryConfig>(config::parse(kQuick, "configuration"));
}

/// With the adjustment of every keyframe.
inline std::string adjusted() {
  std::string yaml = kQuick;
  yaml.replace(yaml.find("rounds: 0"), 9, "rounds: 1");
  return yaml;
}

/// A tenth of a second of given poses shows too few edges.
inline std::string with_short_start() {
  std::string yaml = adjusted();
  yaml.replace(yaml.find("truth_s: 0.2"), 12, "truth_s: 0.1");
  yaml.replace(yaml.find("min_edges: 0"), 12, "min_edges: 900");
  return yaml;
}

class OdometryModule : public SharedFolder<OdometryModule> {
 public:
  static void fill() {
    const PlanarWorld world = corner_world(160, 120);
    const StampedPicture blank{0, ImageU8(world.camera().width, world.camera().height)};
    write_recording(dataset(), world.camera(), world.simulate(glide, 0, kEnd_s, 1e-3, 0.12),
                    std::span(&blank, 1), poses_until(kEnd_s));
  }

 protected:
  [[nodiscard]] static std::filesystem::path dataset() { return path("corner"); }

  [[nodiscard]] RunRequest request(const std::string& name, const std::string& yaml = kQuick) {
    return run_request(dataset(), folder_.path() / name, yaml);
  }

  TemporaryFolder folder_;
};

}  // namespace saccade::testing
