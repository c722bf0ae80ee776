#include "estimator/tracking/event_frame.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/check.h"
#include "estimator/mean_time.h"

namespace saccade {
namespace {

/// Behind each row: two bytes right of it, two left of the next one, and one that nobody reads.
constexpr int kRowPadding = 5;
/// Events are fetched so far ahead, two kilobytes: the processor does it itself only within a page.
constexpr std::ptrdiff_t kEventsAhead = 128;

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

TimeNs EventFrame::draw(std::span<const Event> events) {
  SACCADE_CHECK(!events.empty());
  if (drawing_ == EventFrameOptions::Drawing::kNearest) return draw_nearest(events);
  draw_bilinear(events);
  return mean_time(events);
}

TimeNs EventFrame::draw_nearest(std::span<const Event> events) {
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

std::int32_t EventFrame::nearest_target(const Event& event) const {
  return target_.empty() ? event.y * stride_ + event.x
                         : target_[static_cast<std::size_t>(event.y * width_ + event.x)];
}

TimeNs EventFrame::draw_surface(std::span<const Event> events, double tau_s) {
  SACCADE_CHECK(!events.empty() && tau_s > 0);
  std::uint8_t* pixels = pixels_.data() + origin_;
  const TimeNs newest = events.back().t_ns;
  const auto rate = static_cast<float>(kSecondsPerNs / tau_s);
  double weights = 0;
  double moment = 0;
  for (const Event& e : events) {
    const auto age = static_cast<float>(newest - e.t_ns);
    const float weight = std::exp(-age * rate);
    // In order of time, so that a pixel keeps its last event.
    pixels[nearest_target(e)] = static_cast<std::uint8_t>(weight * kFull + 0.5F);
    weights += static_cast<double>(weight);
    moment += static_cast<double>(weight * age);
  }
  return newest - static_cast<TimeNs>(moment / weights);
}

template <class Write>
void EventFrame::splat(const Eigen::Vector2f& p, const Write& write) const {
  if (!(p.x() >= 0 && p.y() >= 0 && p.x() <= static_cast<float>(width_ - 1) &&
        p.y() <= static_cast<float>(height_ - 1)))
    return;
  const int x0 = static_cast<int>(p.x());
  const int y0 = static_cast<int>(p.y());
  const float fx = p.x() - static_cast<float>(x0);
  const float fy = p.y() - static_cast<float>(y0);
  const int corner = origin_ + y0 * stride_ + x0;
  const auto weigh = [&](int offset, float weight) {
    write(static_cast<std::size_t>(corner + offset), static_cast<int>(weight * kFull + 0.5F));
  };
  weigh(0, (1 - fx) * (1 - fy));
  weigh(1, fx * (1 - fy));
  weigh(stride_, (1 - fx) * fy);
  weigh(stride_ + 1, fx * fy);
}

Eigen::Vector2f EventFrame::position_of(const Event& event) const {
  return undistortion_ ? (*undistortion_)(event.x, event.y) : Eigen::Vector2f(event.x, event.y);
}

void EventFrame::draw_bilinear(std::span<const Event> events) {
  for (const Event& e : events)
    splat(position_of(e), [this](std::size_t i, int weight) { saturate(i, weight); });
}

void EventFrame::accumulate(std::span<const Event> events, int sign) {
  if (sums_.empty()) sums_.resize(pixels_.size());
  const auto write = [this, sign](std::size_t i, int weight) {
    sums_[i] += sign * weight;
    pixels_[i] = static_cast<std::uint8_t>(std::min<int>(sums_[i], kFull));
  };
  for (const Event& e : events) {
    if (drawing_ == EventFrameOptions::Drawing::kBilinear) {
      splat(position_of(e), write);
    } else {
      write(static_cast<std::size_t>(origin_ + nearest_target(e)), kFull);
    }
  }
}

void EventFrame::add(std::span<const Event> events) { accumulate(events, 1); }

void EventFrame::remove(std::span<const Event> events) { accumulate(events, -1); }

void EventFrame::clear() {
  std::fill(pixels_.begin(), pixels_.end(), std::uint8_t{0});
  std::fill(sums_.begin(), sums_.end(), 0);
}

void EventFrame::draw_moved(std::span<const Event> events, TimeNs t_ns, const MotionField& field) {
  const bool is_bilinear = drawing_ == EventFrameOptions::Drawing::kBilinear;
  const auto right = static_cast<float>(width_ - 1);
  const auto bottom = static_cast<float>(height_ - 1);
  for (const Event& e : events) {
    const Eigen::Vector2f start = position_of(e);
    if (!(start.x() >= 0 && start.y() >= 0 && start.x() <= right && start.y() <= bottom)) continue;
    const auto dt_s = static_cast<float>(t_ns - e.t_ns) * static_cast<float>(kSecondsPerNs);
    const Eigen::Vector2f moved = start + dt_s * field(start);
    if (is_bilinear) {
      splat(moved, [this](std::size_t i, int weight) { saturate(i, weight); });
    } else if (moved.x() >= 0 && moved.y() >= 0 && moved.x() <= right && moved.y() <= bottom) {
      const int x = static_cast<int>(moved.x() + 0.5F);
      const int y = static_cast<int>(moved.y() + 0.5F);
      pixels_[static_cast<std::size_t>(origin_ + y * stride_ + x)] = kFull;
    }
  }
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

double time_constant(const EventFrameOptions& options, std::span<const Event> events) {
  if (options.tau_s) return *options.tau_s;
  const TimeNs duration = events.back().t_ns - events.front().t_ns;
  return options.tau_share * seconds_from_ns(std::max<TimeNs>(duration, 1));
}

}  // namespace saccade
