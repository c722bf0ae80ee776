#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/event.h"
#include "estimator/tracking/motion_field.h"

namespace saccade {

/// How events are written into an event frame.
struct EventFrameOptions {
  enum class Kind { kBinary, kTimeSurface };
  enum class Drawing { kNearest, kBilinear };
  enum class Window { kDisjoint, kSliding };

  double ratio = 0.4;    ///< r, events per pixel of the template (thesis 4.21), > 0
  int min_events = 200;  ///< a frame has at least that many, however little of the map is in view
  Drawing drawing = Drawing::kNearest;  ///< with bilinear, weights of one pixel add up to at most 1
  Kind kind = Kind::kBinary;
  /// Time constant of kTimeSurface, as a share of the frame's duration, or [s] where that is
  /// stated.
  double tau_share = 0.5;
  std::optional<double> tau_s;
  bool motion_compensation = false;  ///< of kBinary: events move to the time of the frame
  Window window = Window::kDisjoint;
  double step = 0.25;  ///< of kSliding: share of a frame's events that are new, (0, 1]
};

/// The image I of the tracker (thesis 4.6): full where an event fell, on the undistorted sensor.
/// Drawing and clearing cost O(events). One byte per pixel keeps a 240 x 180 frame in the
/// first-level cache, where both the drawing and the sampling of the aligner go to random places.
class EventFrame {
 public:
  static constexpr std::uint8_t kFull = 255;

  EventFrame(const PinholeCamera& camera, EventFrameOptions::Drawing drawing);

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
  /// In place of draw(), on an empty frame: exp((t - t_newest) / tau) of each pixel's last event
  /// (nearest pixel). `events` is in order of time and not empty, `tau_s` > 0. The mean time of the
  /// events under these weights, which is what the frame shows [ns].
  TimeNs draw_surface(std::span<const Event> events, double tau_s);

  /// In place of draw(): every event where the field takes it from its own time to `t_ns`.
  void draw_moved(std::span<const Event> events, TimeNs t_ns, const MotionField& field);

  /// Becomes the means of 2 x 2 pixels of a frame of twice the size.
  void draw_halved(const EventFrame& fine);

  /// Back to zero.
  void clear();

  /// As draw(), but the frame remembers how often a pixel was drawn, so that remove() takes back
  /// exactly what add() drew. Not to be mixed with draw(). Costs O(events).
  void add(std::span<const Event> events);
  void remove(std::span<const Event> events);

 private:
  TimeNs draw_nearest(std::span<const Event> events);
  void draw_bilinear(std::span<const Event> events);
  [[nodiscard]] std::int32_t nearest_target(const Event& event) const;
  template <class Write>
  void splat(const Eigen::Vector2f& position, const Write& write) const;
  void saturate(std::size_t pixel, int weight) {
    pixels_[pixel] = static_cast<std::uint8_t>(std::min<int>(pixels_[pixel] + weight, kFull));
  }
  [[nodiscard]] Eigen::Vector2f position_of(const Event& event) const;
  void accumulate(std::span<const Event> events, int sign);

  int width_;
  int height_;
  int stride_;
  int origin_;  ///< offset of pixel (0, 0)
  EventFrameOptions::Drawing drawing_;
  std::vector<std::uint8_t> pixels_;
  std::vector<std::int32_t> sums_;  ///< of add(): weights before they saturate; empty until then
  /// Where each sensor pixel is drawn, as an offset from (0, 0); pixels that leave the undistorted
  /// sensor go to a byte that nobody reads. Empty without distortion.
  std::vector<std::int32_t> target_;
  std::optional<UndistortionTable> undistortion_;
};

/// The time constant of a surface of these events [s], > 0; at least one event.
[[nodiscard]] double time_constant(const EventFrameOptions& options, std::span<const Event> events);

}  // namespace saccade
