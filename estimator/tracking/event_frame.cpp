#include "estimator/tracking/event_frame.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace saccade {
namespace {

/// Behind each row: two bytes right of it, two left of the next one, and one that nobody reads.
constexpr int kRowPadding = 5;

}  // namespace

EventFrame::EventFrame(const PinholeCamera& camera, EventFrameOptions::Drawing drawing)
    : width_(camera.width),
      height_(camera.height),
      stride_(camera.width + kRowPadding),
      origin_(stride_ + 2),
      drawing_(drawing),
      pixels_(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height_ + 3)) {
  if (!camera.is_distorted()) return;
  const UndistortionTable& table = undistortion_.emplace(camera);
  const std::int32_t nowhere = width_ + 2;
  target_.reserve(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const Eigen::Vector2f p = table(x, y);
      const int px = static_cast<int>(std::lround(p.x()));
      const int py = static_cast<int>(std::lround(p.y()));
      const bool inside = px >= 0 && py >= 0 && px < width_ && py < height_;
      target_.push_back(inside ? py * stride_ + px : nowhere);
    }
}

void EventFrame::draw(std::span<const Event> events) {
  if (drawing_ == EventFrameOptions::Drawing::kNearest) {
    draw_nearest(events);
  } else {
    draw_bilinear(events);
  }
}

void EventFrame::draw_nearest(std::span<const Event> events) {
  std::uint8_t* pixels = pixels_.data() + origin_;
  if (target_.empty()) {
    for (const Event& e : events) pixels[e.y * stride_ + e.x] = kFull;
  } else {
    for (const Event& e : events)
      pixels[target_[static_cast<std::size_t>(e.y * width_ + e.x)]] = kFull;
  }
}

void EventFrame::draw_bilinear(std::span<const Event> events) {
  for (const Event& e : events) {
    const Eigen::Vector2f p =
        undistortion_ ? (*undistortion_)(e.x, e.y) : Eigen::Vector2f(e.x, e.y);
    if (!(p.x() >= 0 && p.y() >= 0 && p.x() <= static_cast<float>(width_ - 1) &&
          p.y() <= static_cast<float>(height_ - 1)))
      continue;
    const int x0 = static_cast<int>(p.x());
    const int y0 = static_cast<int>(p.y());
    const float fx = p.x() - static_cast<float>(x0);
    const float fy = p.y() - static_cast<float>(y0);
    std::uint8_t* corner = &pixels_[static_cast<std::size_t>(origin_ + y0 * stride_ + x0)];
    const auto add = [](std::uint8_t& pixel, float weight) {
      const int sum = pixel + static_cast<int>(weight * kFull + 0.5F);
      pixel = static_cast<std::uint8_t>(std::min<int>(sum, kFull));
    };
    add(corner[0], (1 - fx) * (1 - fy));
    add(corner[1], fx * (1 - fy));
    add(corner[stride_], (1 - fx) * fy);
    add(corner[stride_ + 1], fx * fy);
  }
}

void EventFrame::clear() { std::fill(pixels_.begin(), pixels_.end(), std::uint8_t{0}); }

TimeNs mean_time(std::span<const Event> events) {
  SACCADE_CHECK(!events.empty());
  const TimeNs first = events.front().t_ns;
  TimeNs sum = 0;
  for (const Event& e : events) sum += e.t_ns - first;
  return first + sum / static_cast<TimeNs>(events.size());
}

}  // namespace saccade
