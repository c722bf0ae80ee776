#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/event.h"
#include "simulator/scene/scene.h"
#include "simulator/sensor/event_options.h"
#include "simulator/sensor/image_motion.h"
#include "simulator/sensor/pixel_rays.h"
#include "simulator/motion/pose_table.h"

namespace saccade {

/// What all tiles of an event camera share; outlives them.
struct EventWorld {
  const Scene& scene;
  const PixelRays& rays;
  EventOptions options;
};

/// What was spent and reached.
struct EventStatistics {
  std::uint64_t rays = 0;           ///< visibility rays
  std::uint64_t surface_looks = 0;  ///< evaluations of a known triangle, without a ray
  double time_bound_s = 0;          ///< widest final bracket around a crossing

  void add(const EventStatistics& other);
};

/// 4 x 4 event pixels that are traced in lockstep, one packet of rays per step. Between two steps a
/// pixel's signal is evaluated alone, wherever the crossings' search asks for it: on the triangle
/// that both ends of the interval see, or with a ray where they see different ones. A step is
/// searched when the one after it has been traced, so that the search knows the signal on both
/// sides.
class EventTile {
 public:
  virtual ~EventTile() = default;

  /// Takes the references at time `t_s`. Here and below the poses reach back to searched_s().
  virtual void start(const PoseTable& poses, double t_s) = 0;
  /// Traces up to `t_s` in `steps` >= 1 equal steps and searches all but the last of them.
  virtual void advance(const PoseTable& poses, double t_s, int steps) = 0;
  /// Searches the last step.
  virtual void finish(const PoseTable& poses) = 0;

  /// Events before this time are complete.
  [[nodiscard]] virtual double searched_s() const = 0;
  /// Of the surfaces that the pixels see now.
  [[nodiscard]] virtual InverseDepthRange inverse_depths() const = 0;

  /// Moves out the events found since the last call, step by step and pixel by pixel; times rounded
  /// to the unit.
  void take_events(Events& out) {
    out.insert(out.end(), events_.begin(), events_.end());
    events_.clear();
  }
  [[nodiscard]] const EventStatistics& statistics() const { return statistics_; }

 protected:
  Events events_;
  EventStatistics statistics_;
};

/// Tile `index` of `world.rays`, for its number of rays per pixel.
[[nodiscard]] std::unique_ptr<EventTile> make_event_tile(const EventWorld& world,
                                                         std::size_t index);

}  // namespace saccade
