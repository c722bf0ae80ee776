#pragma once

#include <cstddef>
#include <span>

#include "core/event.h"
#include "estimator/tracking/edges/event_frame.h"

namespace saccade {

/// Which events of a stream make up a frame: one run after another, or with kSliding the newest n,
/// of which `new_fraction` are new. A frame costs what enters and leaves it.
class EventWindow {
 public:
  explicit EventWindow(const EventFrameOptions& options) : options_(options) {}

  /// Begins with a stream, which outlives its frames.
  void start(std::span<const Event> stream);

  /// Moves on to the next frame, of `count` >= 1 events. When `count` grows, a sliding frame
  /// reaches it by keeping its oldest events. False when the stream has too few events left:
  /// nothing moves.
  [[nodiscard]] bool advance(std::size_t count);

  [[nodiscard]] std::span<const Event> events() const;
  /// The newest `count` events of the stream until the frame's end, as many as there are.
  [[nodiscard]] std::span<const Event> newest(std::size_t count) const;
  /// What the last advance() added and took away.
  [[nodiscard]] std::span<const Event> entered() const;
  [[nodiscard]] std::span<const Event> left() const;
  /// Of the frame's events, the fraction that no frame before it had.
  [[nodiscard]] double new_fraction() const;
  /// Mean time of the frame's events [ns].
  [[nodiscard]] TimeNs mean_time() const;

 private:
  EventFrameOptions options_;
  std::span<const Event> stream_;
  std::size_t begin_ = 0, end_ = 0;
  std::size_t last_begin_ = 0, last_end_ = 0;
  TimeNs sum_ = 0;  ///< of the times since the stream's first event [ns]
};

}  // namespace saccade
