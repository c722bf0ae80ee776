#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/event.h"

namespace saccade {

/// How events are written into an event frame.
struct EventFrameOptions {
  enum class Drawing { kNearest, kBilinear };

  double ratio = 0.4;    ///< r, events per pixel of the template (thesis 4.21), > 0
  int min_events = 200;  ///< a frame has at least that many, however little of the map is in view
  Drawing drawing = Drawing::kNearest;  ///< with bilinear, weights of one pixel add up to at most 1
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

  /// Adds events; their coordinates lie on the sensor (contract of every event reader).
  void draw(std::span<const Event> events);
  /// Back to zero.
  void clear();

 private:
  void draw_nearest(std::span<const Event> events);
  void draw_bilinear(std::span<const Event> events);

  int width_;
  int height_;
  int stride_;
  int origin_;  ///< offset of pixel (0, 0)
  EventFrameOptions::Drawing drawing_;
  std::vector<std::uint8_t> pixels_;
  /// Where each sensor pixel is drawn, as an offset from (0, 0); pixels that leave the undistorted
  /// sensor go to a byte that nobody reads. Empty without distortion.
  std::vector<std::int32_t> target_;
  std::optional<UndistortionTable> undistortion_;
};

/// Mean time of the events [ns], which stamps the pose of their frame; at least one event.
[[nodiscard]] TimeNs mean_time(std::span<const Event> events);

}  // namespace saccade
