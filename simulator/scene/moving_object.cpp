#include "simulator/scene/moving_object.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/check.h"

namespace saccade {
namespace {

/// Each interval has pieces as short as its own motion asks for.
constexpr double kStretch_s = 0.05;

/// Ends before every recording starts.
Spline at_rest() {
  const std::array<Rigid3, 4> poses{};
  return Spline::from_control_poses(poses, -kStretch_s, kStretch_s);
}

}  // namespace

MovingObject::MovingObject(std::uint32_t object, std::optional<Spline> world_from_object,
                           const Eigen::AlignedBox3d& box,
                           std::shared_ptr<const VertexAnimation> animation)
    : object_(object),
      has_trajectory_(world_from_object.has_value()),
      world_from_object_(world_from_object ? std::move(*world_from_object) : at_rest()),
      box_(box),
      animation_(std::move(animation)) {
  SACCADE_CHECK(!box.isEmpty());
  const double from_s = world_from_object_.start_s();
  const double span_s = world_from_object_.end_s() - from_s;
  const double count = std::ceil(span_s / kStretch_s);
  tables_per_s_ = count / span_s;
  tables_.reserve(static_cast<std::size_t>(count));
  for (double k = 0; k < count; ++k)
    tables_.emplace_back(world_from_object_, from_s + k / tables_per_s_,
                         from_s + (k + 1) / tables_per_s_);
}

SplineState MovingObject::state(double t_s) const {
  SplineState state = world_from_object_.state(t_s);
  if (t_s >= world_from_object_.start_s() && t_s <= world_from_object_.end_s()) return state;
  state.velocity_in_world.setZero();
  state.acceleration_in_world.setZero();
  state.angular_velocity_in_body.setZero();
  state.angular_acceleration_in_body.setZero();
  return state;
}

CameraFrame MovingObject::frame(double t_s) const {
  const double t = std::clamp(t_s, world_from_object_.start_s(), world_from_object_.end_s());
  const auto index = static_cast<std::size_t>((t - world_from_object_.start_s()) * tables_per_s_);
  return tables_[std::min(index, tables_.size() - 1)].at(t);
}

}  // namespace saccade
