#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/camera.h"
#include "core/spline/spline.h"
#include "simulator/scene/scene.h"
#include "simulator/sensor/adaptive/adaptive_tile.h"
#include "simulator/sensor/adaptive/audit.h"
#include "simulator/sensor/event_delivery.h"
#include "simulator/sensor/event_options.h"

namespace saccade {

/// The event camera that samples with rays and proves nothing: many times faster than EventCamera
/// where many triangles are in view, at the price of some missed and late events. How many is
/// measured: a random share of the tiles is recorded by an EventCamera, too, and both are compared
/// (Audit).
///
/// Tiles of 4 x 4 pixels step on their own, so that nothing in them or next to them moves by more
/// than max_step_px. Slices of a few milliseconds only share the speeds of neighbours. The stream is
/// the same for any number of threads.
class AdaptiveCamera {
 public:
  /// As EventCamera has it.
  AdaptiveCamera(const Scene& scene, const Spline& world_from_camera, const PinholeCamera& camera,
                 const EventOptions& options, std::uint64_t seed = 1);

  using Sink = EventDelivery::Sink;

  /// Records from time 0, or from where a resumed camera was, to `duration_s` > 0. Call once.
  void record(double duration_s, const Sink& sink);
  /// The first slice of record() that is not recorded yet.
  void step(double duration_s, const Sink& sink);
  [[nodiscard]] double reached_s() const { return t_s_; }

  [[nodiscard]] std::string state() const;
  /// Before record(); throws InputError where the state does not fit.
  void resume(std::string_view state);

  /// `time_bound_s` stays 0, for there is no bound.
  [[nodiscard]] EventStatistics statistics() const;
  /// Of the whole recording.
  [[nodiscard]] AuditResult audit() const { return audit_.result(); }
  [[nodiscard]] std::vector<AuditedCounts> audited_counts() const { return audit_.counts(); }

 private:
  [[nodiscard]] double slice_end_s(double duration_s) const;
  [[nodiscard]] Surroundings around(std::size_t tile, const std::vector<Surroundings>& tiles) const;

  const Scene& scene_;
  const Spline& motion_;
  EventOptions options_;
  PixelRays rays_;
  PixelNoise noise_;
  std::vector<std::unique_ptr<AdaptiveTile>> tiles_;
  double t_s_ = 0;  ///< up to which all tiles have sensed
  bool started_ = false;
  EventDelivery delivery_;
  Audit audit_;
};

}  // namespace saccade
