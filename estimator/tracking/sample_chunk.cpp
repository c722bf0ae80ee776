#include "estimator/tracking/sample_chunk.h"

#include <algorithm>
#include <cstring>

#include "core/check.h"

namespace saccade {
namespace {

constexpr int kLanes = 16;

/// A mixing of 32 bits in which every input bit changes every output bit about half of the time
/// (multiply-xorshift): enough for choosing samples, and vector code.
std::uint32_t mix(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352dU;
  x ^= x >> 15;
  x *= 0x846ca68bU;
  x ^= x >> 16;
  return x;
}

}  // namespace

void SampleChunk::load(std::span<const TemplatePoint> points, int first, int count, int total,
                       std::uint32_t key) {
  SACCADE_CHECK(count > 0 && count <= kCapacity && !points.empty());
  count_ = count;
  padded_count_ = (count + kLanes - 1) / kLanes * kLanes;
  const auto size = static_cast<float>(points.size());
  const float run = size / static_cast<float>(total);
  const int last = static_cast<int>(points.size()) - 1;
  for (int i = 0; i < padded_count_; ++i) {
    constexpr float kUnit = 0x1p-24F;
    const auto draw = static_cast<std::uint32_t>(first + i);
    const float uniform = static_cast<float>(mix(draw * 0x9E3779B9U + key) >> 8) * kUnit;
    const float position = (static_cast<float>(first + i) + uniform) * run;
    pixel_[static_cast<std::size_t>(i)] = std::min(static_cast<int>(position), last);
  }
  gather(points);
}

void SampleChunk::load_all(std::span<const TemplatePoint> points) {
  SACCADE_CHECK(points.size() <= kCapacity && !points.empty());
  count_ = static_cast<int>(points.size());
  padded_count_ = (count_ + kLanes - 1) / kLanes * kLanes;
  for (int i = 0; i < padded_count_; ++i)
    pixel_[static_cast<std::size_t>(i)] = std::min(i, count_ - 1);
  gather(points);
}

void SampleChunk::gather(std::span<const TemplatePoint> points) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(padded_count_); ++i) {
    const TemplatePoint& p = points[static_cast<std::size_t>(pixel_[i])];
    ray_x_[i] = p.ray.x();
    ray_y_[i] = p.ray.y();
    inverse_depth_[i] = p.inverse_depth;
    value_[i] = p.value;
    slope_x_[i] = p.slope.x();
    slope_y_[i] = p.slope.y();
  }
}

void SampleChunk::warp(const PinholeCamera& camera, const EventFrame& frame,
                       const Rigid3& current_from_template) {
  const Eigen::Matrix3f r = current_from_template.rotation_matrix().cast<float>();
  const Eigen::Vector3f t = current_from_template.translation().cast<float>();
  const auto fx = static_cast<float>(camera.fx);
  const auto fy = static_cast<float>(camera.fy);
  const auto cx = static_cast<float>(camera.cx);
  const auto cy = static_cast<float>(camera.cy);
  // Half open: the neighbours to the right and below exist.
  const auto right = static_cast<float>(camera.width - 1);
  const auto bottom = static_cast<float>(camera.height - 1);
  const int stride = frame.stride();
  for (std::size_t i = 0; i < static_cast<std::size_t>(padded_count_); ++i) {
    const float x = ray_x_[i];
    const float y = ray_y_[i];
    const float w = inverse_depth_[i];
    const float pz = r(2, 0) * x + r(2, 1) * y + r(2, 2) + t.z() * w;
    const float px = r(0, 0) * x + r(0, 1) * y + r(0, 2) + t.x() * w;
    const float py = r(1, 0) * x + r(1, 1) * y + r(1, 2) + t.y() * w;
    const float u = fx * px / pz + cx;
    const float v = fy * py / pz + cy;
    const bool inside = (pz > 0) & (u >= 0) & (v >= 0) & (u < right) & (v < bottom);
    const float safe_u = inside ? u : 0;
    const float safe_v = inside ? v : 0;
    const int column = static_cast<int>(safe_u);
    const int row = static_cast<int>(safe_v);
    visible_[i] = inside ? 1.0F : 0.0F;
    fraction_x_[i] = safe_u - static_cast<float>(column);
    fraction_y_[i] = safe_v - static_cast<float>(row);
    pixel_[i] = row * stride + column;
  }
  for (std::size_t i = static_cast<std::size_t>(count_);
       i < static_cast<std::size_t>(padded_count_); ++i)
    visible_[i] = 0;
}

void SampleChunk::show_all() {
  visible_.fill(0);
  std::fill_n(visible_.begin(), count_, 1.0F);
}

void SampleChunk::compare(const EventFrame& frame, bool smooth, float gain, float offset) {
  if (smooth) {
    read_smooth(frame);
  } else {
    read_bilinear(frame);
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(padded_count_); ++i)
    residual_[i] = visible_[i] * (frame_value_[i] - gain * value_[i] - offset);
}

void SampleChunk::read_smooth(const EventFrame& frame) {
  const std::uint8_t* pixels = frame.data();
  const int stride = frame.stride();
  for (std::size_t i = 0; i < static_cast<std::size_t>(padded_count_); ++i) {
    std::uint32_t rows[4];
    for (int k = 0; k < 4; ++k)
      std::memcpy(&rows[k], pixels + pixel_[i] + (k - 1) * stride - 1, sizeof rows[k]);
    for (std::size_t k = 0; k < 4; ++k) windows_[k][i] = rows[k];
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(padded_count_); ++i) {
    const float fx = fraction_x_[i];
    const float fy = fraction_y_[i];
    const auto line = [&](std::size_t k) {
      const std::uint32_t n = windows_[k][i];
      const auto byte = [n](int j) {
        return static_cast<float>(static_cast<int>(n >> (8 * j) & 255U));
      };
      return (1 - fx) * byte(0) + byte(1) + byte(2) + fx * byte(3);
    };
    constexpr float kScale = 1.0F / (9 * EventFrame::kFull);
    frame_value_[i] = kScale * ((1 - fy) * line(0) + line(1) + line(2) + fy * line(3));
  }
}

void SampleChunk::read_bilinear(const EventFrame& frame) {
  const std::uint8_t* pixels = frame.data();
  const int stride = frame.stride();
  for (std::size_t i = 0; i < static_cast<std::size_t>(padded_count_); ++i) {
    std::uint16_t above = 0;
    std::uint16_t below = 0;
    std::memcpy(&above, pixels + pixel_[i], sizeof above);
    std::memcpy(&below, pixels + pixel_[i] + stride, sizeof below);
    neighbours_[i] = above | static_cast<std::uint32_t>(below) << 16;
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(padded_count_); ++i) {
    constexpr float kScale = 1.0F / EventFrame::kFull;
    const std::uint32_t n = neighbours_[i];
    const auto byte = [n](int k) {
      return static_cast<float>(static_cast<int>(n >> (8 * k) & 255U));
    };
    const float top = byte(0) + fraction_x_[i] * (byte(1) - byte(0));
    const float low = byte(2) + fraction_x_[i] * (byte(3) - byte(2));
    frame_value_[i] = kScale * (top + fraction_y_[i] * (low - top));
  }
}

void SampleChunk::weigh(RobustWeight kind, float sigma) {
  if (!(sigma > 0)) return;
  const auto apply = [&](RobustWeight fixed_kind) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(padded_count_); ++i) {
      const float root = sqrt_weight(fixed_kind, residual_[i] / sigma);
      visible_[i] *= root;
      residual_[i] *= root;
    }
  };
  // One loop for each kind, so that it is vector code.
  if (kind == RobustWeight::kHuber) apply(RobustWeight::kHuber);
  if (kind == RobustWeight::kTukey) apply(RobustWeight::kTukey);
}

void SampleChunk::differentiate() {
  for (std::size_t i = 0; i < static_cast<std::size_t>(padded_count_); ++i) {
    const float a = slope_x_[i] * visible_[i];
    const float b = slope_y_[i] * visible_[i];
    const float x = ray_x_[i];
    const float y = ray_y_[i];
    const float radial = a * x + b * y;
    columns_[0][i] = a * inverse_depth_[i];
    columns_[1][i] = b * inverse_depth_[i];
    columns_[2][i] = -radial * inverse_depth_[i];
    columns_[3][i] = -y * radial - b;
    columns_[4][i] = x * radial + a;
    columns_[5][i] = b * x - a * y;
    columns_[6][i] = value_[i] * visible_[i];
    columns_[7][i] = visible_[i];
  }
}

double SampleChunk::dot(const Floats& a, const Floats& b) const {
  // Sixteen partial sums in a fixed order: vector code without reassociation by the compiler.
  float sums[kLanes] = {};
  for (std::size_t i = 0; i < static_cast<std::size_t>(padded_count_); i += kLanes)
    for (std::size_t lane = 0; lane < kLanes; ++lane) sums[lane] += a[i + lane] * b[i + lane];
  for (std::size_t width = kLanes / 2; width > 0; width /= 2)
    for (std::size_t lane = 0; lane < width; ++lane) sums[lane] += sums[lane + width];
  return static_cast<double>(sums[0]);
}

double SampleChunk::column_dot_residual(int column) const {
  return dot(columns_[static_cast<std::size_t>(column)], residual_);
}

double SampleChunk::column_dot_column(int a, int b) const {
  return dot(columns_[static_cast<std::size_t>(a)], columns_[static_cast<std::size_t>(b)]);
}

double SampleChunk::squared_residual() const { return dot(residual_, residual_); }

double SampleChunk::visible() const { return dot(visible_, visible_); }

double SampleChunk::agreeing(float mean_value, float mean_frame) const {
  int count = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(padded_count_); ++i) {
    const bool agrees = (value_[i] > mean_value) == (frame_value_[i] > mean_frame);
    count += static_cast<int>(agrees & (visible_[i] > 0));
  }
  return count;
}

}  // namespace saccade
