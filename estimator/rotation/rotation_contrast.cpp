#include "estimator/rotation/rotation_contrast.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace saccade {
namespace {

constexpr int kMargin = 16;  // [px]

/// Somewhere within a pixel, evenly: an additive recurrence by the plastic number (Roberts, 2018).
Eigen::Vector2f within_pixel(std::size_t k) {
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

RotationContrast::RotationContrast(const PinholeCamera& camera, double blur_px,
                                   std::size_t max_events)
    : camera_(camera.undistorted()),
      undistortion_(camera),
      kernel_(half_gaussian(blur_px)),
      max_events_(max_events),
      margin_(kMargin + static_cast<int>(kernel_.size())),
      image_(camera.width + 2 * margin_, camera.height + 2 * margin_),
      row_sums_(image_.width(), image_.height()) {
  SACCADE_CHECK(max_events > 0);
}

void RotationContrast::load(std::span<const Event> events) {
  SACCADE_CHECK(!events.empty());
  const TimeNs middle_ns = (events.front().t_ns + events.back().t_ns) / 2;
  middle_s_ = seconds_from_ns(middle_ns);
  const std::size_t every = (events.size() + max_events_ - 1) / max_events_;
  ray_x_.clear();
  ray_y_.clear();
  time_s_.clear();
  const auto fx = static_cast<float>(camera_.fx), fy = static_cast<float>(camera_.fy);
  const auto cx = static_cast<float>(camera_.cx), cy = static_cast<float>(camera_.cy);
  double squares = 0;
  for (std::size_t i = 0; i < events.size(); i += every) {
    const Eigen::Vector2f& pixel = undistortion_(events[i].x, events[i].y);
    // As fired, all events lie in the middles of pixels, where bilinear drawing is sharpest: every
    // turn would seem to blur them.
    const Eigen::Vector2f place = pixel + within_pixel(ray_x_.size());
    ray_x_.push_back((place.x() - cx) / fx);
    ray_y_.push_back((place.y() - cy) / fy);
    const double t_s = seconds_from_ns(events[i].t_ns - middle_ns);
    time_s_.push_back(static_cast<float>(t_s));
    squares += t_s * t_s;
  }
  x_.resize(ray_x_.size());
  y_.resize(ray_x_.size());
  px_per_rate_ = camera_.fx * std::sqrt(squares / static_cast<double>(ray_x_.size()));
}

void RotationContrast::warp(const Eigen::Vector3d& w) {
  const auto fx = static_cast<float>(camera_.fx), fy = static_cast<float>(camera_.fy);
  const auto cx = static_cast<float>(camera_.cx + margin_);
  const auto cy = static_cast<float>(camera_.cy + margin_);
  const auto wx = static_cast<float>(w.x()), wy = static_cast<float>(w.y());
  const auto wz = static_cast<float>(w.z());
  const float right = static_cast<float>(image_.width() - margin_ + kMargin);
  const float bottom = static_cast<float>(image_.height() - margin_ + kMargin);
  const float least = static_cast<float>(margin_ - kMargin);
  for (std::size_t i = 0; i < ray_x_.size(); ++i) {
    const float a = ray_x_[i], b = ray_y_[i], t = time_s_[i];
    // exp(t w) to second order: within 2e-4 px at 0.1 rad.
    const float tx = t * wx, ty = t * wy, tz = t * wz;
    const float cross_x = ty - tz * b, cross_y = tz * a - tx, cross_z = tx * b - ty * a;
    const float x = a + cross_x + 0.5F * (ty * cross_z - tz * cross_y);
    const float y = b + cross_y + 0.5F * (tz * cross_x - tx * cross_z);
    const float z = 1 + cross_z + 0.5F * (tx * cross_y - ty * cross_x);
    const float u = fx * x / z + cx, v = fy * y / z + cy;
    const bool inside = (u >= least) & (v >= least) & (u < right) & (v < bottom);
    x_[i] = inside ? u : -1;
    y_[i] = v;
  }
}

void RotationContrast::draw() {
  image_.fill(0);
  for (std::size_t i = 0; i < x_.size(); ++i)
    if (x_[i] >= 0) splat(image_, x_[i], y_[i], 1.0F);
}

void RotationContrast::smooth() {
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

auto RotationContrast::evaluate(const Eigen::Vector3d& w) -> Value {
  warp(w);
  draw();
  smooth();
  const double norm = 1 / (static_cast<double>(x_.size()) * static_cast<double>(x_.size()));
  Value value;
  for (const float pixel : image_.pixels())
    value.contrast += static_cast<double>(pixel) * static_cast<double>(pixel);
  value.contrast *= norm;
  smooth();
  const auto fx = static_cast<float>(camera_.fx), fy = static_cast<float>(camera_.fy);
  const auto cx = static_cast<float>(camera_.cx + margin_);
  const auto cy = static_cast<float>(camera_.cy + margin_);
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  Eigen::Vector3d total = Eigen::Vector3d::Zero();
  constexpr std::size_t kBlock = 256;  // summed in single precision
  for (std::size_t i = 0; i < x_.size(); ++i) {
    if (x_[i] >= 0) {
      const auto slope = sample_with_gradient(image_, x_[i], y_[i]);
      const float gx = fx * slope.dx, gy = fy * slope.dy;
      // dx/dw at the warped place, to first order in the turn: t times the motion field of a
      // rotation, [-a b, 1 + a^2, -b; -1 - b^2, a b, a] with the sign of x' = x + t w cross x.
      const float a = (x_[i] - cx) / fx, b = (y_[i] - cy) / fy, t = time_s_[i];
      sum += t * Eigen::Vector3f(-a * b * gx - (1 + b * b) * gy, (1 + a * a) * gx + a * b * gy,
                                 a * gy - b * gx);
    }
    if (i % kBlock == kBlock - 1 || i + 1 == x_.size()) {
      total += sum.cast<double>();
      sum.setZero();
    }
  }
  value.gradient = 2 * norm * total;
  return value;
}

}  // namespace saccade
