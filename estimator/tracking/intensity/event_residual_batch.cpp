#include "estimator/tracking/intensity/event_residual_batch.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/check.h"
#include "estimator/tracking/robust_loss.h"

namespace saccade {
namespace {

/// Further than this from its sample the map is not extrapolated linearly [px].
constexpr float kMaxExtrapolation_px = 3;
constexpr float kNearest_m = 1e-6F;

}  // namespace

void EventResidualBatch::add(const LogIntensityObservation& observation, const MapSample& at) {
  SACCADE_CHECK(count_ < kCapacity);
  const auto i = static_cast<std::size_t>(count_++);
  // What fills the lanes behind the last observation weighs nothing.
  if (i % kLanes == 0) std::fill_n(&variance_[i], kLanes, std::numeric_limits<float>::infinity());
  point_x_[i] = at.point.x();
  point_y_[i] = at.point.y();
  point_z_[i] = at.point.z();
  pixel_x_[i] = observation.pixel.x();
  pixel_y_[i] = observation.pixel.y();
  time_s_[i] = observation.time_s;
  log_intensity_[i] = observation.log_intensity;
  variance_[i] = observation.variance;
  dead_zone_[i] = observation.dead_zone;
  region_weight_[i] = observation.region_weight;
  atlas_x_[i] = at.atlas_px.x();
  atlas_y_[i] = at.atlas_px.y();
  scale_xx_[i] = at.atlas_per_pixel(0, 0);
  scale_xy_[i] = at.atlas_per_pixel(0, 1);
  scale_yx_[i] = at.atlas_per_pixel(1, 0);
  scale_yy_[i] = at.atlas_per_pixel(1, 1);
}

void EventResidualBatch::evaluate(const PinholeCamera& camera, const ImageF& atlas,
                                  const ImageF& variance, const Motion& motion) {
  const auto fx = static_cast<float>(camera.fx);
  const auto fy = static_cast<float>(camera.fy);
  const auto cx = static_cast<float>(camera.cx);
  const auto cy = static_cast<float>(camera.cy);
  const auto right = static_cast<float>(atlas.width() - 1);
  const auto bottom = static_cast<float>(atlas.height() - 1);
  const Eigen::Matrix3f r = motion.rotation;
  const Eigen::Vector3f t = motion.translation;
  const Eigen::Vector3f v = motion.velocity.head<3>();
  const Eigen::Vector3f w = motion.velocity.tail<3>();
  const int width = atlas.width();
  for (std::size_t i = 0; i < padded(); ++i) {
    const float mx = point_x_[i];
    const float my = point_y_[i];
    const float mz = point_z_[i];
    const float ax = r(0, 0) * mx + r(0, 1) * my + r(0, 2) * mz + t.x();
    const float ay = r(1, 0) * mx + r(1, 1) * my + r(1, 2) * mz + t.y();
    const float az = r(2, 0) * mx + r(2, 1) * my + r(2, 2) * mz + t.z();
    const float dt = time_s_[i];
    const float px = ax - dt * (v.x() + w.y() * az - w.z() * ay);
    const float py = ay - dt * (v.y() + w.z() * ax - w.x() * az);
    const float pz = az - dt * (v.z() + w.x() * ay - w.y() * ax);
    // Finite in the camera's very centre, too, where the padding of a new chunk may lie.
    const float inverse = 1 / std::max(pz, kNearest_m);
    const float x = px * inverse;
    const float y = py * inverse;
    const float ex = pixel_x_[i] - (fx * x + cx);
    const float ey = pixel_y_[i] - (fy * y + cy);
    const float u = atlas_x_[i] + scale_xx_[i] * ex + scale_xy_[i] * ey;
    const float z = atlas_y_[i] + scale_yx_[i] * ex + scale_yy_[i] * ey;
    const bool is_visible = (pz > 0) & (std::abs(ex) < kMaxExtrapolation_px) &
                            (std::abs(ey) < kMaxExtrapolation_px) & (u >= 0) & (z >= 0) &
                            (u < right) & (z < bottom);
    visible_[i] = is_visible ? 1.0F : 0.0F;
    const float safe_u = is_visible ? u : 0;
    const float safe_v = is_visible ? z : 0;
    const int column = static_cast<int>(safe_u);
    const int row = static_cast<int>(safe_v);
    at_x_[i] = safe_u - static_cast<float>(column);
    at_y_[i] = safe_v - static_cast<float>(row);
    cell_[i] = row * width + column;
    ray_x_[i] = x;
    ray_y_[i] = y;
    inverse_depth_[i] = inverse;
  }
  read(atlas, variance);
  for (std::size_t i = 0; i < padded(); ++i) {
    const float a = fx * (slope_x_[i] * scale_xx_[i] + slope_y_[i] * scale_yx_[i]);
    const float b = fy * (slope_x_[i] * scale_xy_[i] + slope_y_[i] * scale_yy_[i]);
    const float x = ray_x_[i];
    const float y = ray_y_[i];
    const float iz = inverse_depth_[i];
    const float radial = a * x + b * y;
    columns_[0][i] = a * iz;
    columns_[1][i] = b * iz;
    columns_[2][i] = -radial * iz;
    columns_[3][i] = -y * radial - b;
    columns_[4][i] = x * radial + a;
    columns_[5][i] = b * x - a * y;
  }
}

void EventResidualBatch::read(const ImageF& atlas, const ImageF& variance) {
  const float* texels = atlas.data();
  const float* variations = variance.data();
  const int width = atlas.width();
  for (std::size_t i = 0; i < padded(); ++i) {
    const float* cell = texels + cell_[i];
    const float a = cell[0];
    const float b = cell[1];
    const float c = cell[width];
    const float d = cell[width + 1];
    const float top = a + at_x_[i] * (b - a);
    const float low = c + at_x_[i] * (d - c);
    const float value = top + at_y_[i] * (low - top);
    slope_x_[i] = (b - a) + at_y_[i] * ((d - c) - (b - a));
    slope_y_[i] = low - top;
    const float* v = variations + cell_[i];
    const float upper = v[0] + at_x_[i] * (v[1] - v[0]);
    const float lower = v[width] + at_x_[i] * (v[width + 1] - v[width]);
    variation_[i] = upper + at_y_[i] * (lower - upper);
    const bool is_known = visible_[i] > 0 && value == value;
    visible_[i] = is_known ? 1.0F : 0.0F;
    const float difference = is_known ? log_intensity_[i] - value : 0;
    residual_[i] = difference - std::clamp(difference, -dead_zone_[i], dead_zone_[i]);
    slope_x_[i] = is_known ? slope_x_[i] : 0;
    slope_y_[i] = is_known ? slope_y_[i] : 0;
  }
}

void EventResidualBatch::weigh(const MapNoise& noise) {
  const float variance = noise.sigma * noise.sigma;
  const float position = noise.position_sigma_px * noise.position_sigma_px;
  constexpr auto kTail = static_cast<float>(kCauchyScale);
  constexpr float kScale = 1 / (kTail * kTail);
  for (std::size_t i = 0; i < padded(); ++i) {
    map_variance_[i] = variance + position * variation_[i];
    const float precision = 1 / (variance_[i] + map_variance_[i]);
    relative_[i] = residual_[i] * residual_[i] * precision * kScale;
    const bool is_in_dead_zone = dead_zone_[i] > 0 && residual_[i] == 0;
    weight_[i] = (is_in_dead_zone ? 0 : region_weight_[i]) * visible_[i] * variance * precision /
                 (1 + relative_[i]);
    known_[i] = visible_[i] * variance / (variance + variance_[i]);
  }
}

void EventResidualBatch::add_to(Sums& sums) {
  LaneSums known{}, inliers{}, weight{}, squares{};
  for (std::size_t first = 0; first < padded(); first += kLanes)
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::size_t i = first + lane;
      const float cauchy = known_[i] / (1 + relative_[i]);
      known[lane] += known_[i];
      inliers[lane] += relative_[i] < 1 ? known_[i] : 0;
      weight[lane] += cauchy;
      squares[lane] += cauchy * residual_[i] * residual_[i];
    }
  sums.known += total(known);
  sums.inliers += total(inliers);
  sums.weight += total(weight);
  sums.squares += total(squares);
  for (std::size_t c = 0; c < 6; ++c) {
    for (std::size_t i = 0; i < padded(); ++i) weighted_[c][i] = weight_[i] * columns_[c][i];
    const auto column = static_cast<Eigen::Index>(c);
    sums.rhs(column) += dot(weighted_[c].data(), residual_.data(), padded());
    for (std::size_t d = 0; d <= c; ++d)
      sums.normal(static_cast<Eigen::Index>(d), column) +=
          dot(weighted_[c].data(), columns_[d].data(), padded());
  }
}

float EventResidualBatch::residual(int i) const {
  const auto k = static_cast<std::size_t>(i);
  return visible_[k] > 0 ? residual_[k] : std::numeric_limits<float>::quiet_NaN();
}

float EventResidualBatch::relative(int i) const { return relative_[static_cast<std::size_t>(i)]; }

float EventResidualBatch::certainty(int i) const { return known_[static_cast<std::size_t>(i)]; }

float EventResidualBatch::log_intensity(int i) const {
  return log_intensity_[static_cast<std::size_t>(i)];
}

float EventResidualBatch::map_variance(int i) const {
  return map_variance_[static_cast<std::size_t>(i)];
}

float EventResidualBatch::variance_per_px2(int i) const {
  return variation_[static_cast<std::size_t>(i)];
}

}  // namespace saccade
