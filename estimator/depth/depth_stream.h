#pragma once

#include <functional>
#include <span>

#include "core/event.h"
#include "core/trajectory.h"
#include "estimator/depth/depth_estimator.h"

namespace saccade {

/// Depth while events come in: they are handed over in chunks of any size, and whenever the window
/// in work is full its view is estimated. The views are the same however the events are chunked.
class DepthStream {
 public:
  /// A finished view: its time, and what was found.
  using Sink = std::function<void(double reference_s, const DepthResult& result)>;

  /// Windows of `window_s` > 0 from the first event on, each with its view after `reference_share`
  /// of it, 0..1. `estimator` outlives this.
  DepthStream(const DepthEstimator& estimator, double window_s, double reference_share, Sink sink);

  /// Events in order of time, also across calls. `trajectory`: poses up to the last of them, at
  /// least for the window in work.
  void push(std::span<const Event> events, const Trajectory& trajectory);

  /// Estimates from what the last window holds so far, then starts anew.
  void finish(const Trajectory& trajectory);

 private:
  void estimate(const Trajectory& trajectory, double end_s);

  const DepthEstimator& estimator_;
  TimeNs window_ns_;
  double reference_share_;
  Sink sink_;
  Events events_;  ///< of the window in work
};

}  // namespace saccade
