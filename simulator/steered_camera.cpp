#include "simulator/steered_camera.h"

#include <span>

#include "core/error.h"
#include "simulator/event_source.h"
#include "simulator/scene/build_scene.h"

namespace saccade {
namespace {

/// A segment of the cubic spline is defined by so many control poses.
constexpr std::size_t kControlPoses = 4;

const SimulationConfig& checked(const SimulationConfig& config, double dt_s) {
  if (!(dt_s > 0)) throw InputError("dt", "must be above 0 s");
  if (config.events.colour_filter != ColourFilter::kNone)
    throw InputError("events.colour_filter", "a steered camera has none; state none");
  if (config.events.sampling != Sampling::kExact && config.events.sampling != Sampling::kAuto)
    throw InputError("events.sampling", "a steered camera samples exactly; state exact");
  return config;
}

Scene rigid_scene(const SimulationConfig& config) {
  Scene scene = build_scene(config.scene);
  static_cast<void>(chosen_sampling(Sampling::kExact, scene));  // or an error, at once
  return scene;
}

}  // namespace

SteeredCamera::SteeredCamera(const SimulationConfig& config, const Rigid3& world_from_start,
                             double dt_s)
    : config_(checked(config, dt_s)),
      dt_s_(dt_s),
      scene_(rigid_scene(config)),
      control_poses_(kControlPoses, world_from_start),
      motion_(Spline::from_control_poses(control_poses_, 0, dt_s)),
      renderer_(scene_, config_.camera, config.events.samples_per_pixel,
                config.events.texture_filter),
      camera_(scene_, motion_, config_.camera, config_.events, config_.seed) {
  control_poses_.pop_back();  // the first command states it
}

Events SteeredCamera::advance(const Twist& command) {
  if (!command.allFinite()) throw InputError("policy", "must return six finite numbers");
  control_poses_.push_back(control_poses_.back() * Rigid3::exp(dt_s_ * command));
  // One interval before this one stays, in which rounding may put the camera's time.
  if (control_poses_.size() > kControlPoses + 1) {
    control_poses_.erase(control_poses_.begin());
    first_s_ = static_cast<double>(intervals_ - 1) * dt_s_;
  }
  motion_ = Spline::from_control_poses(control_poses_, first_s_, dt_s_);
  ++intervals_;
  t_s_ = static_cast<double>(intervals_) * dt_s_;
  Events events;
  while (camera_.reached_s() < t_s_)
    camera_.step_until(t_s_, [&](std::span<const SensedEvent> sensed, double) {
      for (const SensedEvent& event : sensed) events.push_back(event.event());
    });
  return events;
}

ImageF SteeredCamera::frame() const {
  const StampedPose pose{t_s_, world_from_camera()};
  return renderer_.radiance(std::span(&pose, 1));
}

ImageF SteeredCamera::depth() const { return renderer_.depth({t_s_, world_from_camera()}); }

}  // namespace saccade
