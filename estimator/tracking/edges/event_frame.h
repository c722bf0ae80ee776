#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/event.h"

namespace saccade {

/// Which events make an event frame, and what its pixels hold.
struct EventFrameOptions {
  enum class Kind { kBinary, kTimeSurface };
  enum class Window { kDisjoint, kSliding };

  double event_map_ratio = 0.4;  ///< r of (4.21)
  /// However little of the map is in view: of fewer events noise would make the frame.
  int min_events = 200;
  Kind kind = Kind::kBinary;
  /// Time constant of a time surface as a fraction of its frame's duration: half of it keeps the
  /// older events visible at every speed.
  double decay_fraction = 0.5;
  Window window = Window::kDisjoint;
  double new_fraction = 0.25;  ///< of the events of a sliding frame, (0, 1]: four times the poses
};

/// The image I of the tracker (thesis section 4.6): full where an event fell, on the undistorted
/// sensor. Drawing and clearing cost O(events). One byte per pixel keeps a 240 x 180 frame in the
/// first-level cache, where both the drawing and the sampling of the aligner go to random places.
class EventFrame {
 public:
  static constexpr std::uint8_t kFull = 255;

  explicit EventFrame(const PinholeCamera& camera);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  /// Bytes from one row to the next. One row above, one below, and two pixels left and right of the
  /// image may be read; they are empty.
  [[nodiscard]] int stride() const { return stride_; }
  [[nodiscard]] const std::uint8_t* data() const { return pixels_.data() + origin_; }
  [[nodiscard]] std::uint8_t operator()(int x, int y) const { return data()[y * stride_ + x]; }

  /// Adds events; their coordinates lie on the sensor (contract of every event reader). Returns
  /// their mean time [ns], as they pass through the cache only once; `events` is not empty.
  TimeNs draw(std::span<const Event> events);
  /// In place of draw(), on an empty frame: the time surface exp((t - t_newest) / tau) of each
  /// pixel's last event (thesis chapter 9), with tau = `decay_fraction` times the duration of the
  /// events, which are in order of time and not empty. Returns the mean time of the events under
  /// these weights [ns].
  TimeNs draw_surface(std::span<const Event> events, double decay_fraction);

  /// Becomes the means of 2 x 2 pixels of a frame of twice the size.
  void draw_halved(const EventFrame& fine);

  /// Back to zero.
  void clear();

  /// As draw(), but the frame remembers how often a pixel was drawn, so that remove() takes back
  /// exactly what add() drew. Not to be mixed with draw(). Costs O(events).
  void add(std::span<const Event> events);
  void remove(std::span<const Event> events);

 private:
  [[nodiscard]] std::int32_t target_of(const Event& event) const;
  void count(std::span<const Event> events, int sign);

  int width_;
  int height_;
  int stride_;
  int origin_;  ///< offset of pixel (0, 0)
  std::vector<std::uint8_t> pixels_;
  std::vector<std::int32_t> counts_;  ///< of add(): events per pixel; empty until then
  /// Where each sensor pixel is drawn, as an offset from (0, 0); pixels that leave the undistorted
  /// sensor go to a byte that nobody reads. Empty without distortion.
  std::vector<std::int32_t> target_;
};

}  // namespace saccade
