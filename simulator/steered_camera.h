#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "core/event.h"
#include "core/image.h"
#include "core/rigid3.h"
#include "core/spline/spline.h"
#include "simulator/scene/scene.h"
#include "simulator/sensor/event_camera.h"
#include "simulator/sensor/image_renderer.h"
#include "simulator/simulation_config.h"

namespace saccade {

/// An event camera that is steered while it records, by a policy that sees its events. It moves
/// along a uniform cubic spline whose newest control pose each command adds,
///   c_(k+1) = c_k exp(dt xi),
/// so that the motion is smooth (C2), as that of a body with inertia: a command takes effect over
/// the interval that it begins and the three after it. It starts at rest. Sampling is exact
/// (EventCamera).
class SteeredCamera {
 public:
  /// Scene, camera, events and seed of `config` count, its trajectory does not. Throws InputError for
  /// another sampling than exact or auto, a colour filter, an animated scene, and dt_s <= 0.
  SteeredCamera(const SimulationConfig& config, const Rigid3& world_from_start, double dt_s);
  SteeredCamera(const SteeredCamera&) = delete;  // the camera refers to the scene beside it
  SteeredCamera& operator=(const SteeredCamera&) = delete;

  /// Moves on by dt_s under the command of a twist (v, w) in the camera's axes [m/s, rad/s];
  /// returns the events of that time. Those of its last ticks, which are not settled yet, come with
  /// the next call.
  [[nodiscard]] Events advance(const Twist& command);

  [[nodiscard]] double t_s() const { return t_s_; }
  [[nodiscard]] Rigid3 world_from_camera() const { return motion_.pose(t_s_); }
  [[nodiscard]] const PinholeCamera& camera() const { return config_.camera; }
  /// Linear radiance and z depth [m] now.
  [[nodiscard]] ImageF frame() const;
  [[nodiscard]] ImageF depth() const;

 private:
  SimulationConfig config_;
  double dt_s_;
  Scene scene_;
  std::vector<Rigid3>
      control_poses_;   ///< those that the motion of this and the last interval needs
  double first_s_ = 0;  ///< where the segment of the first of them begins
  Spline motion_;       ///< the camera refers to it
  ImageRenderer renderer_;
  EventCamera camera_;
  std::size_t intervals_ = 0;  ///< so far
  double t_s_ = 0;
};

}  // namespace saccade
