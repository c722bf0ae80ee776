#include "core/trajectory.h"

#include "core/check.h"
#include "core/time_search.h"

namespace saccade {

Trajectory::Trajectory(std::vector<StampedPose> poses) : poses_(std::move(poses)) {
  for (std::size_t i = 1; i < poses_.size(); ++i) SACCADE_CHECK(poses_[i - 1].t_s < poses_[i].t_s);
}

std::optional<std::size_t> Trajectory::last_before(double t_s) const {
  const std::size_t count = count_until(poses_, t_s, &StampedPose::t_s);
  if (count == 0) return std::nullopt;
  return count - 1;
}

std::optional<Rigid3> Trajectory::at(double t_s) const {
  if (empty() || t_s < start_s() || t_s > end_s()) return std::nullopt;
  return at_clamped(t_s);
}

Rigid3 Trajectory::at_clamped(double t_s) const {
  SACCADE_CHECK(!empty());
  const std::optional<std::size_t> before = last_before(t_s);
  if (!before) return poses_.front().world_from_camera;
  const StampedPose& a = poses_[*before];
  if (*before + 1 == poses_.size()) return a.world_from_camera;
  const StampedPose& b = poses_[*before + 1];
  return interpolate(a.world_from_camera, b.world_from_camera, (t_s - a.t_s) / (b.t_s - a.t_s));
}

double Trajectory::path_length() const {
  double length = 0;
  for (std::size_t i = 1; i < poses_.size(); ++i)
    length +=
        (poses_[i].world_from_camera.translation() - poses_[i - 1].world_from_camera.translation())
            .norm();
  return length;
}

}  // namespace saccade
