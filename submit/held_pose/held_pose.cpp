// Holds the last given pose: the smallest program that reads events and poses by the installed libraries and writes a
// trajectory. Of the events it takes nothing but their times; what a method does in its place begins at `pose_at`.
//   held_pose EVENTS.h5 WIDTH HEIGHT START.txt TRAJECTORY.txt
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <vector>

#include "core/io/events/event_file.h"
#include "core/io/trajectory_file.h"
#include "core/trajectory.h"

namespace {

constexpr double kPoseEveryS = 0.001;

saccade::StampedPose pose_at(double t_s, const saccade::Trajectory& start) {
  return {t_s, start.poses().back().world_from_camera};
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 6) {
    std::fputs("usage: held_pose EVENTS.h5 WIDTH HEIGHT START.txt TRAJECTORY.txt\n", stderr);
    return 2;
  }
  const saccade::Events events =
      saccade::read_events(argv[1], {std::atoi(argv[2]), std::atoi(argv[3])});
  const saccade::Trajectory start = saccade::read_tum_trajectory(argv[4]);
  std::vector<saccade::StampedPose> poses;
  for (const saccade::Event& event : events) {
    const double t_s = saccade::seconds_from_ns(event.t_ns);
    if (poses.empty() || t_s >= poses.back().t_s + kPoseEveryS)
      poses.push_back(pose_at(t_s, start));
  }
  saccade::write_tum_trajectory(argv[5], poses);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "held_pose: %s\n", error.what());
  return 1;
}
