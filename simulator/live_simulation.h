#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>

#include "core/event.h"
#include "core/image.h"
#include "core/io/images/exr_file.h"
#include "core/spline/spline.h"
#include "simulator/event_source.h"
#include "simulator/scene/scene.h"
#include "simulator/sensor/image_renderer.h"
#include "simulator/simulation_config.h"

namespace saccade {

/// The first camera of a simulation, for a program that takes its events as they come and looks at
/// the scene at any time. The events are those that simulate() writes, however they are taken.
class LiveSimulation {
 public:
  /// Throws InputError as simulate() does.
  explicit LiveSimulation(const SimulationConfig& config);
  LiveSimulation(const LiveSimulation&) = delete;  // the cameras refer to the scene beside them
  LiveSimulation& operator=(const LiveSimulation&) = delete;

  [[nodiscard]] const PinholeCamera& camera() const { return config_.camera; }
  [[nodiscard]] const Spline& world_from_camera() const { return motion_; }
  [[nodiscard]] double duration_s() const { return motion_.end_s(); }

  /// Goes back to the beginning.
  void restart();
  /// The next events with t < `t_s`, those before which were taken already left out; from
  /// duration_s() on all that are left. `between` is called between the slices of the simulation,
  /// and what it throws leaves the rest to the next call.
  [[nodiscard]] Events take_until(double t_s, const std::function<void()>& between = {});

  /// Linear radiance, z depth [m] (0 = nothing hit) and motion field [px/s] at an instant of
  /// [0, duration_s()], without exposure.
  [[nodiscard]] ImageF frame(double t_s) const;
  [[nodiscard]] ImageF depth(double t_s) const;
  [[nodiscard]] FlowField flow(double t_s) const;

 private:
  SimulationConfig config_;
  Spline motion_;
  Scene scene_;
  std::optional<ColourScenes> colours_;
  ImageRenderer renderer_;
  std::unique_ptr<EventSource> source_;
  Events found_;           ///< of the slices so far, but those of earlier calls
  std::size_t taken_ = 0;  ///< of found_
};

}  // namespace saccade
