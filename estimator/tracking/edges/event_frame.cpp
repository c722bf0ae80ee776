#include "estimator/tracking/edges/event_frame.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/check.h"

namespace saccade {
namespace {

/// Behind each row: two bytes right of it, two left of the next one, and one that nobody reads.
constexpr int kRowPadding = 5;
/// Events are fetched so far ahead, two kilobytes: the processor does it itself only within a page.
constexpr std::ptrdiff_t kEventsAhead = 128;

}  // namespace

EventFrame::EventFrame(const PinholeCamera& camera)
    : width_(camera.width),
      height_(camera.height),
      stride_(camera.width + kRowPadding),
      origin_(stride_ + 2),
      pixels_(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height_ + 3)) {
  if (!camera.is_distorted()) return;
  const UndistortionTable table(camera);
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

TimeNs EventFrame::draw(std::span<const Event> events) {
  SACCADE_CHECK(!events.empty());
  std::uint8_t* pixels = pixels_.data() + origin_;
  const TimeNs first = events.front().t_ns;
  TimeNs sum = 0;
  if (target_.empty()) {
    const int stride = stride_;  // the bytes that are written may alias anything but a local
    for (const Event& e : events) {
      __builtin_prefetch(&e + kEventsAhead);
      pixels[e.y * stride + e.x] = kFull;
      sum += e.t_ns - first;
    }
  } else {
    const std::int32_t* target = target_.data();
    const int width = width_;
    for (const Event& e : events) {
      pixels[target[e.y * width + e.x]] = kFull;
      sum += e.t_ns - first;
    }
  }
  return first + sum / static_cast<TimeNs>(events.size());
}

std::int32_t EventFrame::target_of(const Event& event) const {
  return target_.empty() ? event.y * stride_ + event.x
                         : target_[static_cast<std::size_t>(event.y * width_ + event.x)];
}

TimeNs EventFrame::draw_surface(std::span<const Event> events, double decay_fraction) {
  SACCADE_CHECK(!events.empty() && decay_fraction > 0);
  const TimeNs duration = events.back().t_ns - events.front().t_ns;
  const double tau_s = decay_fraction * seconds_from_ns(std::max<TimeNs>(duration, 1));
  std::uint8_t* pixels = pixels_.data() + origin_;
  const TimeNs newest = events.back().t_ns;
  const auto rate = static_cast<float>(kSecondsPerNs / tau_s);
  double weights = 0;
  double moment = 0;
  for (const Event& e : events) {
    const auto age = static_cast<float>(newest - e.t_ns);
    const float weight = std::exp(-age * rate);
    // In order of time, so that a pixel keeps its last event.
    pixels[target_of(e)] = static_cast<std::uint8_t>(weight * kFull + 0.5F);
    weights += static_cast<double>(weight);
    moment += static_cast<double>(weight * age);
  }
  return newest - static_cast<TimeNs>(moment / weights);
}

void EventFrame::count(std::span<const Event> events, int sign) {
  if (counts_.empty()) counts_.resize(pixels_.size());
  for (const Event& e : events) {
    const auto i = static_cast<std::size_t>(origin_ + target_of(e));
    counts_[i] += sign;
    pixels_[i] = counts_[i] > 0 ? kFull : std::uint8_t{0};
  }
}

void EventFrame::add(std::span<const Event> events) { count(events, 1); }

void EventFrame::remove(std::span<const Event> events) { count(events, -1); }

void EventFrame::clear() {
  std::fill(pixels_.begin(), pixels_.end(), std::uint8_t{0});
  std::fill(counts_.begin(), counts_.end(), 0);
}

void EventFrame::draw_halved(const EventFrame& fine) {
  SACCADE_CHECK(width_ == fine.width_ / 2 && height_ == fine.height_ / 2);
  for (int y = 0; y < height_; ++y) {
    const std::uint8_t* above = fine.data() + 2 * y * fine.stride_;
    const std::uint8_t* below = above + fine.stride_;
    std::uint8_t* out = pixels_.data() + origin_ + y * stride_;
    for (int x = 0; x < width_; ++x) {
      const int sum = above[2 * x] + above[2 * x + 1] + below[2 * x] + below[2 * x + 1];
      out[x] = static_cast<std::uint8_t>((sum + 2) / 4);
    }
  }
}

}  // namespace saccade
