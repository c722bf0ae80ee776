#include "estimator/rotation/rotation_contrast.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

RotationContrast::RotationContrast(const PinholeCamera& camera, double blur_px, double burst_share,
                                   std::size_t max_events)
    : camera_(camera.undistorted()),
      undistortion_(camera),
      kernel_(half_gaussian(blur_px)),
      burst_share_(burst_share),
      max_events_(max_events),
      margin_(kMargin + static_cast<int>(kernel_.size())),
      image_(camera.width + 2 * margin_, camera.height + 2 * margin_),
      row_sums_(image_.width(), image_.height()),
      last_ns_(2 * static_cast<std::size_t>(camera.width) *
               static_cast<std::size_t>(camera.height)) {
  SACCADE_CHECK(max_events > 0 && burst_share >= 0);
}

void RotationContrast::choose(std::span<const Event> events) {
  const auto window_ns = static_cast<double>(events.back().t_ns - events.front().t_ns);
  const auto burst_ns = static_cast<TimeNs>(burst_share_ * window_ns);
  last_ns_.assign(last_ns_.size(), std::numeric_limits<TimeNs>::min() / 2);
  chosen_.clear();
  for (std::size_t i = 0; i < events.size(); ++i) {
    const Event& event = events[i];
    const std::size_t pixel =
        static_cast<std::size_t>(event.y) * static_cast<std::size_t>(camera_.width) +
        static_cast<std::size_t>(event.x);
    TimeNs& last_ns = last_ns_[2 * pixel + (event.polarity > 0 ? 1 : 0)];
    if (event.t_ns - last_ns >= burst_ns) chosen_.push_back(i);
    last_ns = event.t_ns;
  }
}

void RotationContrast::load(std::span<const Event> events) {
  SACCADE_CHECK(!events.empty());
  choose(events);
  const TimeNs middle_ns = (events.front().t_ns + events.back().t_ns) / 2;
  middle_s_ = seconds_from_ns(middle_ns);
  const std::size_t every = (chosen_.size() + max_events_ - 1) / max_events_;
  ray_x_.clear();
  ray_y_.clear();
  t_.clear();
  const auto fx = static_cast<float>(camera_.fx), fy = static_cast<float>(camera_.fy);
  const auto cx = static_cast<float>(camera_.cx), cy = static_cast<float>(camera_.cy);
  for (std::size_t k = 0; k < chosen_.size(); k += every) {
    const Event& event = events[chosen_[k]];
    // As fired, all events lie in the middles of pixels, where bilinear drawing is sharpest: every
    // turn would seem to blur them.
    const Eigen::Vector2f place = undistortion_(event.x, event.y) + within_pixel(ray_x_.size());
    ray_x_.push_back((place.x() - cx) / fx);
    ray_y_.push_back((place.y() - cy) / fy);
    t_.push_back(static_cast<float>(seconds_from_ns(event.t_ns - middle_ns)));
  }
  x_.resize(ray_x_.size());
  y_.resize(ray_x_.size());
  set_times();
}

void RotationContrast::set_times() {
  const auto count = static_cast<double>(t_.size());
  Eigen::Vector4d moments = Eigen::Vector4d::Zero();  // of t, t^2, t^3, t^4
  for (const float time : t_) {
    const auto t = static_cast<double>(time);
    moments += Eigen::Vector4d(t, t * t, t * t * t, t * t * t * t) / count;
  }
  const double variance = moments[1] - moments[0] * moments[0];
  const double slope = variance > 0 ? (moments[2] - moments[1] * moments[0]) / variance : 0;
  rate_per_acceleration_ = slope / 2;
  const double offset = (moments[1] - slope * moments[0]) / 2;
  s_.clear();
  double squares = 0;
  for (const float time : t_) {
    const auto t = static_cast<double>(time);
    const double s = t * t / 2 - rate_per_acceleration_ * t - offset;
    s_.push_back(static_cast<float>(s));
    squares += s * s;
  }
  px_per_rate_ = camera_.fx * std::sqrt(std::max(variance, 0.0));
  px_per_acceleration_ = camera_.fx * std::sqrt(squares / count);
}

auto RotationContrast::parameters_of(const Turning& turning) const -> Parameters {
  Parameters parameters;
  parameters << turning.rate + rate_per_acceleration_ * turning.acceleration, turning.acceleration;
  return parameters;
}

Turning RotationContrast::turning_of(const Parameters& parameters) const {
  const Eigen::Vector3d acceleration = parameters.tail<3>();
  return {parameters.head<3>() - rate_per_acceleration_ * acceleration, acceleration};
}

void RotationContrast::warp(const Parameters& parameters) {
  const auto fx = static_cast<float>(camera_.fx), fy = static_cast<float>(camera_.fy);
  const auto cx = static_cast<float>(camera_.cx + margin_);
  const auto cy = static_cast<float>(camera_.cy + margin_);
  const Eigen::Matrix<float, 6, 1> p = parameters.cast<float>();
  const float right = static_cast<float>(image_.width() - margin_ + kMargin);
  const float bottom = static_cast<float>(image_.height() - margin_ + kMargin);
  const float least = static_cast<float>(margin_ - kMargin);
  for (std::size_t i = 0; i < ray_x_.size(); ++i) {
    const float a = ray_x_[i], b = ray_y_[i], t = t_[i], s = s_[i];
    // exp() to second order: within 2e-4 px at 0.1 rad.
    const float tx = t * p[0] + s * p[3], ty = t * p[1] + s * p[4], tz = t * p[2] + s * p[5];
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

auto RotationContrast::evaluate(const Parameters& parameters) -> Value {
  warp(parameters);
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
  Eigen::Matrix<float, 6, 1> sum = Eigen::Matrix<float, 6, 1>::Zero();
  Parameters total = Parameters::Zero();
  constexpr std::size_t kBlock = 256;  // summed in single precision
  for (std::size_t i = 0; i < x_.size(); ++i) {
    if (x_[i] >= 0) {
      const auto slope = sample_with_gradient(image_, x_[i], y_[i]);
      const float gx = fx * slope.dx, gy = fy * slope.dy;
      // At the warped place, to first order in the turn: the motion field of a rotation,
      // [-a b, 1 + a^2, -b; -1 - b^2, a b, a] with the sign of x' = x + angle cross x.
      const float a = (x_[i] - cx) / fx, b = (y_[i] - cy) / fy;
      const Eigen::Vector3f by_angle(-a * b * gx - (1 + b * b) * gy, (1 + a * a) * gx + a * b * gy,
                                     a * gy - b * gx);
      sum.head<3>() += t_[i] * by_angle;
      sum.tail<3>() += s_[i] * by_angle;
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
