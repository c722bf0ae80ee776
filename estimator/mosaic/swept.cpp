#include "estimator/mosaic/swept.h"

namespace saccade {

std::vector<Eigen::Matrix3d> turns_of(const Trajectory& world_from_camera,
                                      std::span<const Event> events) {
  constexpr double kStepS = 1e-3;
  std::vector<Eigen::Matrix3d> turns;
  const double end_s = seconds_from_ns(events.back().t_ns);
  for (double t_s = seconds_from_ns(events.front().t_ns); t_s < end_s; t_s += kStepS)
    turns.push_back(world_from_camera.at_clamped(t_s).rotation_matrix());
  turns.push_back(world_from_camera.at_clamped(end_s).rotation_matrix());
  return turns;
}

}  // namespace saccade
