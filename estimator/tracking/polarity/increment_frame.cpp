#include "estimator/tracking/polarity/increment_frame.h"

#include <algorithm>

namespace saccade {

IncrementFrame::IncrementFrame(const PinholeCamera& camera, bool reversals)
    : reversals_(reversals),
      undistortion_(camera),
      sums_(camera.width, camera.height),
      last_(camera.width, camera.height) {}

void IncrementFrame::reset() { last_.fill({}); }

void IncrementFrame::add(const Eigen::Vector2f& position, int polarity) {
  if (is_inside(sums_, position.x(), position.y()))
    splat(sums_, position.x(), position.y(), static_cast<float>(polarity));
}

void IncrementFrame::draw(std::span<const Event> events, TimeNs t_ns, const ImageMotion& motion,
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
        view(static_cast<int>(pixel.x() + 0.5F), static_cast<int>(pixel.y() + 0.5F)).inverse_depth;
    const Eigen::Vector2f speed_px = motion(pixel, known > 0 ? known : elsewhere);
    const auto wait_s = static_cast<float>(seconds_from_ns(t_ns - event.t_ns));
    add(pixel + wait_s * speed_px, event.polarity);
    if (!reversals_ || before.polarity != -event.polarity) continue;
    const auto since_s = static_cast<float>(seconds_from_ns(event.t_ns - before.t_ns));
    const float earlier_s =
        std::min(kSinceReversal * since_s, kFurthest_px / std::max(speed_px.norm(), kSlowest_px_s));
    add(pixel + (wait_s + earlier_s) * speed_px, event.polarity);
  }
}

}  // namespace saccade
