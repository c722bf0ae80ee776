#include "estimator/tracking/polarity/increment_residual_batch.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "estimator/tracking/robust_loss.h"

namespace saccade {
namespace {

static_assert(IncrementPoints::kSpare >= kLanes);

}  // namespace

void IncrementResidualBatch::evaluate(const PinholeCamera& camera, const ImageF& frame,
                                      const IncrementPoints& points, std::size_t first,
                                      const Rigid3& current_from_template, double gain, float sigma,
                                      float position_sigma_px) {
  SACCADE_CHECK(first < points.count);
  count_ = std::min(points.count - first, kCapacity);
  padded_ = padded_to_lanes(count_);
  gain_ = gain;
  for (std::size_t c = 0; c < 6; ++c) columns_[c] = points.by_pose[c].data() + first;
  columns_[6] = points.increment.data() + first;
  warp(camera, frame, points, first, current_from_template);
  read(frame);
  const auto k = static_cast<float>(gain);
  const float variance = sigma * sigma;
  const float position = position_sigma_px * position_sigma_px * k * k;
  constexpr auto kTail = static_cast<float>(kCauchyScale);
  constexpr float kScale = 1 / (kTail * kTail);
  const float* expected = columns_[6];
  const float* slope = points.slope.data() + first;
  for (std::size_t i = 0; i < padded_; ++i) {
    const float residual = visible_[i] * (value_[i] - k * expected[i]);
    const float precision = 1 / (variance + position * slope[i] * slope[i]);
    residual_[i] = residual;
    relative_[i] = residual * residual * precision * kScale;
    weight_[i] = visible_[i] * variance * precision / (1 + relative_[i]);
  }
}

void IncrementResidualBatch::warp(const PinholeCamera& camera, const ImageF& frame,
                                  const IncrementPoints& points, std::size_t first,
                                  const Rigid3& current_from_template) {
  const auto fx = static_cast<float>(camera.fx);
  const auto fy = static_cast<float>(camera.fy);
  const auto cx = static_cast<float>(camera.cx);
  const auto cy = static_cast<float>(camera.cy);
  const auto right = static_cast<float>(frame.width() - 1);
  const auto bottom = static_cast<float>(frame.height() - 1);
  const int width = frame.width();
  const auto last = static_cast<std::int32_t>(count_);
  const Eigen::Matrix3f r = current_from_template.rotation_matrix().cast<float>();
  const Eigen::Vector3f t = current_from_template.translation().cast<float>();
  const float* ray_x = points.ray_x.data() + first;
  const float* ray_y = points.ray_y.data() + first;
  const float* inverse_depth = points.inverse_depth.data() + first;
  for (std::size_t i = 0; i < padded_; ++i) {
    const float x = ray_x[i];
    const float y = ray_y[i];
    const float iz = inverse_depth[i];
    const float px = r(0, 0) * x + r(0, 1) * y + r(0, 2) + iz * t.x();
    const float py = r(1, 0) * x + r(1, 1) * y + r(1, 2) + iz * t.y();
    const float pz = r(2, 0) * x + r(2, 1) * y + r(2, 2) + iz * t.z();
    const float inverse = 1 / pz;
    const float u = fx * px * inverse + cx;
    const float v = fy * py * inverse + cy;
    const bool is_visible = (pz > 0) & (u >= 0) & (v >= 0) & (u < right) & (v < bottom) &
                            (static_cast<std::int32_t>(i) < last);
    const float safe_u = is_visible ? u : 0;
    const float safe_v = is_visible ? v : 0;
    const int column = static_cast<int>(safe_u);
    const int row = static_cast<int>(safe_v);
    visible_[i] = is_visible ? 1.0F : 0.0F;
    at_x_[i] = safe_u - static_cast<float>(column);
    at_y_[i] = safe_v - static_cast<float>(row);
    cell_[i] = row * width + column;
  }
}

void IncrementResidualBatch::read(const ImageF& frame) {
  const float* pixels = frame.data();
  const int width = frame.width();
  for (std::size_t i = 0; i < padded_; ++i) {
    const float* cell = pixels + cell_[i];
    const float top = cell[0] + at_x_[i] * (cell[1] - cell[0]);
    const float low = cell[width] + at_x_[i] * (cell[width + 1] - cell[width]);
    value_[i] = top + at_y_[i] * (low - top);
  }
}

void IncrementResidualBatch::add_to(Sums& sums) {
  LaneSums visible{}, weight{}, squares{}, product{}, absolute{}, expected{};
  for (std::size_t begin = 0; begin < padded_; begin += kLanes)
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::size_t i = begin + lane;
      const float cauchy = visible_[i] / (1 + relative_[i]);
      const float m = visible_[i] * columns_[6][i];
      visible[lane] += visible_[i];
      weight[lane] += cauchy;
      squares[lane] += cauchy * residual_[i] * residual_[i];
      product[lane] += m * value_[i];
      absolute[lane] += std::abs(m * value_[i]);
      expected[lane] += m * m;
    }
  sums.visible += total(visible);
  sums.weight += total(weight);
  sums.squares += total(squares);
  sums.product += total(product);
  sums.absolute += total(absolute);
  sums.expected += total(expected);
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    for (std::size_t i = 0; i < padded_; ++i) weighted_[i] = weight_[i] * columns_[c][i];
    const auto column = static_cast<Eigen::Index>(c);
    const double scale = c < 6 ? gain_ : 1;
    sums.rhs(column) += scale * dot(weighted_.data(), residual_.data(), padded_);
    for (std::size_t d = 0; d <= c; ++d)
      sums.normal(static_cast<Eigen::Index>(d), column) +=
          scale * (d < 6 ? gain_ : 1) * dot(weighted_.data(), columns_[d], padded_);
  }
}

PoseEquations IncrementResidualBatch::Sums::of_pose() const {
  const Twist by_gain = normal.topRightCorner<6, 1>() / normal(6, 6);
  PoseEquations equations;
  equations.normal = normal.topLeftCorner<6, 6>();
  equations.normal -= by_gain * normal.topRightCorner<6, 1>().transpose();
  equations.rhs = rhs.head<6>() - by_gain * rhs(6);
  return equations;
}

}  // namespace saccade
