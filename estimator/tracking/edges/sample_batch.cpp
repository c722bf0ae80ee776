#include "estimator/tracking/edges/sample_batch.h"

#include <algorithm>
#include <cstring>

#include "core/check.h"

namespace saccade {
namespace {

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

using Quad = float __attribute__((vector_size(16)));

Quad lower_halves(Quad a, Quad b) { return __builtin_shufflevector(a, b, 0, 1, 4, 5); }
Quad upper_halves(Quad a, Quad b) { return __builtin_shufflevector(a, b, 2, 3, 6, 7); }
Quad even_lanes(Quad a, Quad b) { return __builtin_shufflevector(a, b, 0, 2, 4, 6); }
Quad odd_lanes(Quad a, Quad b) { return __builtin_shufflevector(a, b, 1, 3, 5, 7); }
void store(Quad quad, float* target) { std::memcpy(target, &quad, sizeof quad); }

}  // namespace

void SampleBatch::load(std::span<const TemplatePoint> points, int first, int count, int total,
                       std::uint32_t key) {
  SACCADE_CHECK(count > 0 && count <= kCapacity && !points.empty());
  count_ = count;

  const auto size = static_cast<float>(points.size());
  const float run = size / static_cast<float>(total);
  const int last = static_cast<int>(points.size()) - 1;
  for (int i = 0; i < static_cast<int>(padded()); ++i) {
    constexpr float kUnit = 0x1p-24F;
    const auto draw = static_cast<std::uint32_t>(first + i);
    const float uniform = static_cast<float>(mix(draw * 0x9E3779B9U + key) >> 8) * kUnit;
    const float position = (static_cast<float>(first + i) + uniform) * run;
    pixel_[static_cast<std::size_t>(i)] = std::min(static_cast<int>(position), last);
  }
  gather(points);
}

void SampleBatch::load_all(std::span<const TemplatePoint> points) {
  SACCADE_CHECK(points.size() <= kCapacity && !points.empty());
  count_ = static_cast<int>(points.size());

  for (int i = 0; i < static_cast<int>(padded()); ++i)
    pixel_[static_cast<std::size_t>(i)] = std::min(i, count_ - 1);
  gather(points);
}

void SampleBatch::gather(std::span<const TemplatePoint> points) {
  // Four points at a time, transposed in registers: a gather instruction per field costs thrice
  // that.
  static_assert(sizeof(TemplatePoint) == 2 * sizeof(Quad));
  for (std::size_t i = 0; i < padded(); i += 4) {
    Quad head[4];  // ray x, ray y, inverse depth, value
    Quad tail[4];  // slope x, slope y, nothing
    for (std::size_t k = 0; k < 4; ++k) {
      const auto* point =
          reinterpret_cast<const char*>(&points[static_cast<std::size_t>(pixel_[i + k])]);
      std::memcpy(&head[k], point, sizeof(Quad));
      std::memcpy(&tail[k], point + sizeof(Quad), sizeof(Quad));
    }
    const Quad x01 = lower_halves(head[0], head[1]);
    const Quad x23 = lower_halves(head[2], head[3]);
    const Quad z01 = upper_halves(head[0], head[1]);
    const Quad z23 = upper_halves(head[2], head[3]);
    const Quad s01 = lower_halves(tail[0], tail[1]);
    const Quad s23 = lower_halves(tail[2], tail[3]);
    store(even_lanes(x01, x23), &ray_x_[i]);
    store(odd_lanes(x01, x23), &ray_y_[i]);
    store(even_lanes(z01, z23), &inverse_depth_[i]);
    store(odd_lanes(z01, z23), &value_[i]);
    store(even_lanes(s01, s23), &slope_x_[i]);
    store(odd_lanes(s01, s23), &slope_y_[i]);
  }
}

void SampleBatch::warp(const PinholeCamera& camera, const EventFrame& frame,
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
  for (std::size_t i = 0; i < padded(); ++i) {
    const float x = ray_x_[i];
    const float y = ray_y_[i];
    const float w = inverse_depth_[i];
    const float pz = r(2, 0) * x + r(2, 1) * y + r(2, 2) + t.z() * w;
    const float px = r(0, 0) * x + r(0, 1) * y + r(0, 2) + t.x() * w;
    const float py = r(1, 0) * x + r(1, 1) * y + r(1, 2) + t.y() * w;
    const float u = fx * px / pz + cx;  // (4.15)
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
  for (std::size_t i = static_cast<std::size_t>(count_); i < padded(); ++i) visible_[i] = 0;
}

void SampleBatch::show_all() {
  visible_.fill(0);
  std::fill_n(visible_.begin(), count_, 1.0F);
}

void SampleBatch::compare(const EventFrame& frame, bool smooth, float gain, float offset) {
  if (smooth) {
    read_smooth(frame);
  } else {
    read_bilinear(frame);
  }
  for (std::size_t i = 0; i < padded(); ++i)
    residual_[i] = visible_[i] * (frame_value_[i] - gain * value_[i] - offset);  // (4.3)
}

void SampleBatch::read_smooth(const EventFrame& frame) {
  const std::uint8_t* pixels = frame.data();
  const int stride = frame.stride();
  for (std::size_t i = 0; i < padded(); ++i) {
    std::uint32_t rows[4];
    for (int k = 0; k < 4; ++k)
      std::memcpy(&rows[k], pixels + pixel_[i] + (k - 1) * stride - 1, sizeof rows[k]);
    for (std::size_t k = 0; k < 4; ++k) windows_[k][i] = rows[k];
  }
  for (std::size_t i = 0; i < padded(); ++i) {
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

void SampleBatch::read_bilinear(const EventFrame& frame) {
  const std::uint8_t* pixels = frame.data();
  const int stride = frame.stride();
  for (std::size_t i = 0; i < padded(); ++i) {
    std::uint16_t above = 0;
    std::uint16_t below = 0;
    std::memcpy(&above, pixels + pixel_[i], sizeof above);
    std::memcpy(&below, pixels + pixel_[i] + stride, sizeof below);
    neighbours_[i] = above | static_cast<std::uint32_t>(below) << 16;
  }
  for (std::size_t i = 0; i < padded(); ++i) {
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

void SampleBatch::weigh(RobustLoss kind, float sigma) {
  if (!(sigma > 0)) return;
  const auto apply = [&](RobustLoss fixed_kind) {
    for (std::size_t i = 0; i < padded(); ++i) {
      const float root = sqrt_weight(fixed_kind, residual_[i] / sigma);
      visible_[i] *= root;
      residual_[i] *= root;
    }
  };
  // One loop for each kind, so that it is vector code.
  if (kind == RobustLoss::kHuber) apply(RobustLoss::kHuber);
  if (kind == RobustLoss::kTukey) apply(RobustLoss::kTukey);
}

[[gnu::always_inline]] inline std::array<Lanes, SampleBatch::kColumns> SampleBatch::columns_at(
    std::size_t i) const {
  const Lanes visible = load_lanes(&visible_[i]);
  const Lanes a = load_lanes(&slope_x_[i]) * visible;
  const Lanes b = load_lanes(&slope_y_[i]) * visible;
  const Lanes x = load_lanes(&ray_x_[i]);
  const Lanes y = load_lanes(&ray_y_[i]);
  const Lanes inverse_depth = load_lanes(&inverse_depth_[i]);
  const Lanes radial = a * x + b * y;
  // (4.4) with (4.17), for the motion of the point.
  return {a * inverse_depth, b * inverse_depth, -radial * inverse_depth,          -y * radial - b,
          x * radial + a,    b * x - a * y,     load_lanes(&value_[i]) * visible, visible};
}

void SampleBatch::differentiate() {
  for (std::size_t i = 0; i < padded(); i += kLanes) {
    const auto columns = columns_at(i);
    for (std::size_t k = 0; k < kColumns; ++k)
      std::memcpy(&columns_[k][i], &columns[k], sizeof(Lanes));
  }
}

std::array<double, SampleBatch::kColumns> SampleBatch::columns_dot_residual() const {
  // All sums in one pass, without a detour of the columns through memory.
  std::array<Lanes, kColumns> sums{};
  for (std::size_t i = 0; i < padded(); i += kLanes) {
    const auto columns = columns_at(i);
    const Lanes residual = load_lanes(&residual_[i]);
    for (std::size_t k = 0; k < kColumns; ++k) sums[k] += columns[k] * residual;
  }
  std::array<double, kColumns> totals{};
  for (std::size_t k = 0; k < kColumns; ++k) totals[k] = total(sums[k]);
  return totals;
}

double SampleBatch::column_dot_column(int a, int b) const {
  return dot(columns_[static_cast<std::size_t>(a)].data(),
             columns_[static_cast<std::size_t>(b)].data(), padded());
}

double SampleBatch::squared_residual() const {
  return dot(residual_.data(), residual_.data(), padded());
}

double SampleBatch::visible() const { return dot(visible_.data(), visible_.data(), padded()); }

double SampleBatch::agreeing(float mean_value, float mean_frame) const {
  int count = 0;
  for (std::size_t i = 0; i < padded(); ++i) {
    const bool agrees = (value_[i] > mean_value) == (frame_value_[i] > mean_frame);
    count += static_cast<int>(agrees & (visible_[i] > 0));
  }
  return count;
}

}  // namespace saccade
