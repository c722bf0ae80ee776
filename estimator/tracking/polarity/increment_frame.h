#pragma once

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
  IncrementFrame(const PinholeCamera& camera, bool reversals);

  /// No polarity is known of any pixel.
  void reset();

  /// Draws anew. `events` follow those of the last call in time; `view` knows the
  /// depths that `motion` needs; where it knows none the typical one is taken.
  void draw(std::span<const Event> events, TimeNs t_ns, const ImageMotion& motion,
            const MapView& view);

  /// Sums of polarities [thresholds].
  [[nodiscard]] const ImageF& image() const { return sums_; }

 private:
  struct LastEvent {
    TimeNs t_ns = 0;
    int polarity = 0;  ///< 0: none is known
  };
  void add(const Eigen::Vector2f& position, int polarity);

  bool reversals_;
  UndistortionTable undistortion_;
  ImageF sums_;
  Image<LastEvent> last_;  ///< of each sensor pixel
};

}  // namespace saccade
