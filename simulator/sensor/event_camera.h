#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/camera.h"
#include "core/spline/spline.h"
#include "simulator/scene/scene.h"
#include "simulator/sensor/event_delivery.h"
#include "simulator/sensor/event_options.h"
#include "simulator/sensor/event_tile.h"

namespace saccade {

/// The ideal event camera. Pixel u keeps a reference L_ref, first L(u, 0); it fires ON when
/// L = ln(eps + I) rises to L_ref + C_on and OFF when it falls to L_ref - C_off, L_ref moves by
/// exactly that threshold, and the time is that of the crossing of the continuous signal.
///
/// Time advances in slices of at most 30 ms and 8 px of image motion. Within a slice
/// a tile of 8 x 8 pixels (4 x 4 with several rays a pixel, or where only some tiles sense) can see
/// only what is in the tile itself or within 8 px around it; the inverse depths there bound the
/// image motion. Every tile divides the slice as far
/// as its pixels need, down to equal steps of `max_step_px`. Tiles run in parallel and depend on
/// one another only through the state at the slice's start, so the stream is the same for any
/// number of threads.
class EventCamera {
 public:
  /// `scene` and `world_from_camera` (from 0 to the recording's end) must outlive the camera;
  /// `seed` is that of its imperfections. `only`: the tiles of PixelRays that sense, in order; none
  /// stated: all of them.
  EventCamera(const Scene& scene, const Spline& world_from_camera, const PinholeCamera& camera,
              const EventOptions& options, std::uint64_t seed = 1,
              std::span<const std::size_t> only = {});

  /// Receives the events up to a time [s], in SensedEventOrder over all calls; state() may be
  /// called.
  using Sink = EventDelivery::Sink;

  /// Records from time 0, or from where a resumed camera was, to `duration_s` > 0. Call once.
  void record(double duration_s, const Sink& sink);
  /// The first slice of record() that is not recorded yet.
  void step(double duration_s, const Sink& sink);
  /// The same of a recording that goes on after `until_s` along a motion that is known up to there:
  /// the motion that the camera refers to may be replaced by one that is the same until then.
  void step_until(double until_s, const Sink& sink);

  /// The first slice of record() that is not sensed yet, without a delivery: the events of tile `i`
  /// go to take(i, events) in the order in which they were found.
  using Take = std::function<void(std::size_t tile, std::span<const SensedEvent> events)>;
  void advance(double duration_s, const Take& take);
  [[nodiscard]] double reached_s() const { return t_s_; }

  /// All that later events depend on, between two calls of the sink.
  [[nodiscard]] std::string state() const;
  /// Goes on where another camera, made with the same arguments, had got to. Before record();
  /// throws InputError where the state does not fit.
  void resume(std::string_view state);

  [[nodiscard]] EventStatistics statistics() const;

 private:
  /// work(tile, index) for all tiles that are there, in parallel.
  template <class Work>
  void for_each_tile(const Work& work);
  void make_tiles(std::span<const std::size_t> only);
  /// The next slice, and its events in the delivery.
  void take_slice(double until_s);
  void sense_slice(double duration_s);
  /// The tiles in reach of one, itself among them.
  template <class Use>
  void for_each_around(std::size_t tile, const Use& use) const;
  /// Bound of the image speed of every tile over [t, t + longest slice], into motions_; the
  /// largest.
  double bound_speeds(double t_s);
  /// The next time, `duration_s` at the latest, at which an object starts to move or comes to rest.
  [[nodiscard]] double next_motion_change_s(double duration_s) const;
  [[nodiscard]] InverseDepthRange neighbourhood(std::size_t tile) const;

  const Spline& motion_;
  PixelRays rays_;
  TileContext world_;
  std::vector<std::unique_ptr<EventTile>> tiles_;  ///< nullptr: not in reach of one that senses
  std::vector<bool> senses_;                       ///< the others only tell what they see
  std::vector<TileMotion> motions_;                ///< per tile, in px per second
  double t_s_ = 0;                                 ///< up to which all tiles have sensed
  bool started_ = false;
  EventDelivery delivery_;
};

}  // namespace saccade
