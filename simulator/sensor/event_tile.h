#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include "simulator/motion/spline_table.h"
#include "simulator/scene/scene.h"
#include "simulator/sensor/event_options.h"
#include "simulator/sensor/motion/image_motion.h"
#include "simulator/sensor/noise/state_bytes.h"
#include "simulator/sensor/pixel/pixel_bank.h"
#include "simulator/sensor/pixel/pixel_noise.h"
#include "simulator/sensor/pixel/sensed_event.h"
#include "simulator/sensor/rays/pixel_rays.h"
#include "simulator/sensor/rays/ray_tracer.h"

namespace saccade {

/// What all tiles of an event camera share; outlives them.
struct TileContext {
  const Scene& scene;
  const PixelRays& rays;
  EventOptions options;
  std::uint64_t seed;
  PixelNoise noise;
};

/// A short time over which tiles sense.
struct TimeSlice {
  const SplineTable& poses;  ///< cover it
  double end_s = 0;
};

/// How far points can move around a tile during a slice.
struct TileMotion {
  double pixels = 0;         ///< image motion, at most [px]
  double step_divisor = 1;   ///< the steps are that much shorter
  double farthest_m = 0;     ///< of the surfaces around, z depth
  bool has_objects = false;  ///< that move may come into view
};

/// A square of event pixels. Those that provably see one plane all the time are sensed along their exact
/// path over its texture, without rays. The others are traced in lockstep, one packet of rays per
/// step: where the bounds of a pixel's radiance over a step prove that nothing can have fired,
/// nothing more is done; else its signal is searched alone, on the surfaces that both ends of the
/// step see.
class EventTile {
 public:
  virtual ~EventTile() = default;

  /// Sets the pixels' references to the signal at `t_s`, which the poses cover.
  virtual void start(const SplineTable& poses, double t_s) = 0;
  /// Senses to the end of the slice, divided down to equal steps of at most `max_step_px` for the
  /// pixels that need it. Where a single triangle provably fills the tile's surroundings all the
  /// time, no ray is traced and the steps are longer.
  virtual void advance(const TimeSlice& slice, const TileMotion& motion) = 0;

  /// Of the surfaces that the pixels see now.
  [[nodiscard]] virtual InverseDepthRange inverse_depths() const = 0;

  /// Everything that later events depend on.
  virtual void save(StateWriter& state) const = 0;
  /// Of a tile of the same context, in place of start().
  virtual void load(StateReader& state) = 0;

  /// Moves out the events found since the last call, step by step and pixel by pixel; times rounded
  /// to the unit.
  void take_events(SensedEvents& out) { pixels_.take_events(out); }
  [[nodiscard]] const EventStatistics& statistics() const { return statistics_; }

 protected:
  explicit EventTile(PixelBank pixels) : pixels_(std::move(pixels)) {}

  PixelBank pixels_;
  EventStatistics statistics_;
};

/// Tile `index` of `context.rays`, for its number of rays per pixel.
[[nodiscard]] std::unique_ptr<EventTile> make_event_tile(const TileContext& context,
                                                         std::size_t index);
/// The same tile without senses: it traces its rays at the end of each slice for inverse_depths().
[[nodiscard]] std::unique_ptr<EventTile> make_depth_tile(const TileContext& context,
                                                         std::size_t index);

}  // namespace saccade
