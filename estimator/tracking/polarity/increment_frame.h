#pragma once

#include <algorithm>
#include <span>

#include "core/camera.h"
#include "core/event.h"
#include "core/image.h"
#include "estimator/tracking/image_motion.h"
#include "estimator/tracking/map_view.h"

namespace saccade {

/// Brightness increment image: by how much the log intensity of every pixel changed while some
/// events happened, in thresholds: the sum of their polarities, drawn bilinearly on the undistorted
/// sensor where the camera's motion takes each of them until the frame's time.
///
/// With `reversals` an event of the other polarity than its pixel's last one counts twice. The
/// signal lies anywhere within a threshold ahead of the last event, half of one in the mean, and
/// just so behind an event that reverses: it moved by two thresholds, not by one. The first of
/// them was crossed when it passed the value of the last event again. Where the signal reverses
/// like a parabola that is 0.27 of the time between both before the second; it is taken to be 0.3, and
/// never further back than 1.5 px of image motion.
class IncrementFrame {
 public:
  IncrementFrame(const PinholeCamera& camera, bool reversals)
      : reversals_(reversals),
        undistortion_(camera),
        sums_(camera.width, camera.height),
        last_(camera.width, camera.height) {}

  /// No polarity is known of any pixel.
  void reset() { last_.fill({}); }

  /// Draws anew. `events` follow those of the last call in time; `view` knows the
  /// depths that `motion` needs; where it knows none the typical one is taken.
  void draw(std::span<const Event> events, TimeNs t_ns, const ImageMotion& motion,
            const MapView& view) {
    constexpr float kSinceReversal = 0.3F;
    constexpr float kFurthest_px = 1.5F;
    constexpr float kSlowest_px_s = 1;
    sums_.fill(0);
    const auto elsewhere = static_cast<float>(1 / view.typical_depth_m());
    for (const Event& event : events) {
      LastEvent& last = last_(event.x, event.y);
      const LastEvent before = last;
      last = {event.t_ns, event.polarity};
      const Eigen::Vector2f& pixel = undistortion_(event.x, event.y);
      if (!is_inside(sums_, pixel.x(), pixel.y())) continue;
      const float known =
          view(static_cast<int>(pixel.x() + 0.5F), static_cast<int>(pixel.y() + 0.5F))
              .inverse_depth;
      const Eigen::Vector2f speed_px = motion(pixel, known > 0 ? known : elsewhere);
      const auto wait_s = static_cast<float>(seconds_from_ns(t_ns - event.t_ns));
      add(pixel + wait_s * speed_px, event.polarity);
      if (!reversals_ || before.polarity != -event.polarity) continue;
      const auto since_s = static_cast<float>(seconds_from_ns(event.t_ns - before.t_ns));
      const float earlier_s = std::min(kSinceReversal * since_s,
                                       kFurthest_px / std::max(speed_px.norm(), kSlowest_px_s));
      add(pixel + (wait_s + earlier_s) * speed_px, event.polarity);
    }
  }

  /// Sums of polarities [thresholds].
  [[nodiscard]] const ImageF& image() const { return sums_; }

 private:
  struct LastEvent {
    TimeNs t_ns = 0;
    int polarity = 0;  ///< 0: none is known
  };
  void add(const Eigen::Vector2f& position, int polarity) {
    if (is_inside(sums_, position.x(), position.y()))
      splat(sums_, position.x(), position.y(), static_cast<float>(polarity));
  }

  bool reversals_;
  UndistortionTable undistortion_;
  ImageF sums_;
  Image<LastEvent> last_;  ///< of each sensor pixel
};

}  // namespace saccade
