#include "estimator/rotation/warped_image.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/check.h"

namespace saccade {
namespace {

constexpr int kMargin = 16;  // [px]

/// Low-discrepancy offset within a pixel: R2 sequence of the plastic number (Roberts, 2018).
Eigen::Vector2f pixel_offset(std::size_t k) {
  const double i = static_cast<double>(k) + 0.5;
  constexpr double kPlastic = 1.32471795724474602596;
  const double x = i / kPlastic, y = i / (kPlastic * kPlastic);
  return {static_cast<float>(x - std::floor(x)) - 0.5F,
          static_cast<float>(y - std::floor(y)) - 0.5F};
}

/// exp(-x^2 / 2 sigma^2) to three sigmas, so that the whole kernel sums to 1.
std::vector<float> half_gaussian(double sigma) {
  const int radius = std::max(1, static_cast<int>(std::ceil(3 * sigma)));
  std::vector<float> kernel;
  double sum = 0;
  for (int i = 0; i <= radius; ++i) {
    const double value = sigma > 0 ? std::exp(-i * i / (2 * sigma * sigma)) : (i == 0 ? 1 : 0);
    kernel.push_back(static_cast<float>(value));
    sum += i == 0 ? value : 2 * value;
  }
  for (float& value : kernel) value /= static_cast<float>(sum);
  return kernel;
}

}  // namespace

WarpedImage::WarpedImage(const PinholeCamera& camera, double blur_px)
    : kernel_(half_gaussian(blur_px)),
      margin_(kMargin + static_cast<int>(kernel_.size())),
      image_(camera.width + 2 * margin_, camera.height + 2 * margin_),
      row_sums_(image_.width(), image_.height()),
      min_(static_cast<float>(margin_ - kMargin)),
      max_x_(static_cast<float>(image_.width() - margin_ + kMargin)),
      max_y_(static_cast<float>(image_.height() - margin_ + kMargin)) {}

void WarpedImage::draw(std::span<const float> x, std::span<const float> y) {
  image_.fill(0);
  for (std::size_t i = 0; i < x.size(); ++i)
    if (x[i] >= 0) splat(image_, x[i], y[i], 1.0F);
}

void WarpedImage::smooth() {
  const int radius = static_cast<int>(kernel_.size()) - 1;
  const int width = image_.width(), height = image_.height();
  for (int y = 0; y < height; ++y) {
    const float* from = &image_(0, y);
    float* to = &row_sums_(0, y);
    for (int x = radius; x < width - radius; ++x) {
      float sum = kernel_[0] * from[x];
      for (int k = 1; k <= radius; ++k)
        sum += kernel_[static_cast<std::size_t>(k)] * (from[x - k] + from[x + k]);
      to[x] = sum;
    }
  }
  for (int y = radius; y < height - radius; ++y) {
    float* to = &image_(0, y);
    for (int x = 0; x < width; ++x) to[x] = kernel_[0] * row_sums_(x, y);
    for (int k = 1; k <= radius; ++k) {
      const float weight = kernel_[static_cast<std::size_t>(k)];
      const float* above = &row_sums_(0, y - k);
      const float* below = &row_sums_(0, y + k);
      for (int x = 0; x < width; ++x) to[x] += weight * (above[x] + below[x]);
    }
  }
}

double WarpedImage::sum_of_squares() const {
  double sum = 0;
  for (const float pixel : image_.pixels())
    sum += static_cast<double>(pixel) * static_cast<double>(pixel);
  return sum;
}

BurstFilter::BurstFilter(const PinholeCamera& camera, const BurstLimits& limits,
                         std::size_t max_events)
    : camera_(camera.undistorted()),
      undistortion_(camera),
      limits_(limits),
      max_events_(max_events),
      bursts_(2 * static_cast<std::size_t>(camera.width) *
              static_cast<std::size_t>(camera.height)) {
  SACCADE_CHECK(max_events > 0 && limits.gap >= 0 && limits.longest >= 0);
}

void BurstFilter::select(std::span<const Event> events) {
  const auto window_ns = static_cast<double>(events.back().t_ns - events.front().t_ns);
  const auto gap_ns = static_cast<TimeNs>(limits_.gap * window_ns);
  const auto longest_ns = static_cast<TimeNs>(limits_.longest * window_ns);
  constexpr TimeNs kNever = std::numeric_limits<TimeNs>::min() / 2;
  bursts_.assign(bursts_.size(), {kNever, kNever});
  selected_.clear();
  for (std::size_t i = 0; i < events.size(); ++i) {
    const Event& event = events[i];
    const std::size_t pixel =
        static_cast<std::size_t>(event.y) * static_cast<std::size_t>(camera_.width) +
        static_cast<std::size_t>(event.x);
    Burst& burst = bursts_[2 * pixel + (event.polarity > 0 ? 1 : 0)];
    const bool goes_on =
        event.t_ns - burst.last_ns < gap_ns && event.t_ns - burst.first_ns < longest_ns;
    burst.last_ns = event.t_ns;
    if (goes_on) continue;
    burst.first_ns = event.t_ns;
    selected_.push_back(i);
  }
}

WindowRays BurstFilter::rays_of(std::span<const Event> events) {
  SACCADE_CHECK(!events.empty());
  select(events);
  WindowRays rays;
  const TimeNs middle_ns = (events.front().t_ns + events.back().t_ns) / 2;
  rays.middle_s = seconds_from_ns(middle_ns);
  const std::size_t stride = (selected_.size() + max_events_ - 1) / max_events_;
  const auto fx = static_cast<float>(camera_.fx), fy = static_cast<float>(camera_.fy);
  const auto cx = static_cast<float>(camera_.cx), cy = static_cast<float>(camera_.cy);
  for (std::size_t k = 0; k < selected_.size(); k += stride) {
    const Event& event = events[selected_[k]];
    // At the pixel centres, where all events lie, bilinear drawing is sharpest: any motion would
    // blur them.
    const Eigen::Vector2f pixel = undistortion_(event.x, event.y) + pixel_offset(rays.x.size());
    rays.x.push_back((pixel.x() - cx) / fx);
    rays.y.push_back((pixel.y() - cy) / fy);
    rays.t.push_back(static_cast<float>(seconds_from_ns(event.t_ns - middle_ns)));
  }
  return rays;
}

}  // namespace saccade
