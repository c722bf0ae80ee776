#include "estimator/tracking/polarity/increment_template.h"

#include <cmath>
#include <limits>

namespace saccade {

IncrementPoints::IncrementPoints(std::size_t capacity) {
  for (Floats* array : {&ray_x, &ray_y, &inverse_depth, &increment, &slope})
    array->resize(capacity + kSpare);
  for (Floats& array : by_pose) array.resize(capacity + kSpare);
}

IncrementTemplate::IncrementTemplate(const PinholeCamera& camera)
    : camera_(camera),
      picture_(camera.width, camera.height),
      slope_x_(camera.width, camera.height),
      slope_y_(camera.width, camera.height),
      inverse_depth_(camera.width, camera.height),
      increment_(camera.width, camera.height),
      steepness_(camera.width, camera.height, -1),
      points_(picture_.size()) {}

void IncrementTemplate::sample_map(const MapView& view, const ImageF& atlas) {
  for (int y = 0; y < camera_.height; ++y)
    for (int x = 0; x < camera_.width; ++x) {
      const MapSample& at = view(x, y);
      const bool is_visible =
          at.inverse_depth > 0 && is_inside(atlas, at.atlas_px.x(), at.atlas_px.y());
      picture_(x, y) = is_visible ? sample(atlas, at.atlas_px.x(), at.atlas_px.y())
                                  : std::numeric_limits<float>::quiet_NaN();
    }
}

void IncrementTemplate::draw(const MapView& view, const ImageF& atlas) {
  sample_map(view, atlas);
  inverse_depth_.fill(0);
  slope_x_.fill(0);
  slope_y_.fill(0);
  for (int y = 1; y + 1 < camera_.height; ++y)
    for (int x = 1; x + 1 < camera_.width; ++x) {
      const float slope_x = 0.5F * (picture_(x + 1, y) - picture_(x - 1, y));
      const float slope_y = 0.5F * (picture_(x, y + 1) - picture_(x, y - 1));
      if (!std::isfinite(slope_x + slope_y + picture_(x, y))) continue;
      slope_x_(x, y) = slope_x;
      slope_y_(x, y) = slope_y;
      inverse_depth_(x, y) = view(x, y).inverse_depth;
    }
}

void IncrementTemplate::expect_increments(const Twist& velocity) {
  const auto fx = static_cast<float>(camera_.fx);
  const auto fy = static_cast<float>(camera_.fy);
  const auto cx = static_cast<float>(camera_.cx);
  const Eigen::Matrix<float, 6, 1> v = velocity.cast<float>();
  for (int row = 0; row < camera_.height; ++row) {
    const auto y = static_cast<float>((row - camera_.cy) / camera_.fy);
    const float* slope_x = &slope_x_(0, row);
    const float* slope_y = &slope_y_(0, row);
    const float* inverse_depth = &inverse_depth_(0, row);
    float* increment = &increment_(0, row);
    for (int column = 0; column < camera_.width; ++column) {
      const float x = (static_cast<float>(column) - cx) / fx;
      const float iz = inverse_depth[column];
      const float along_x = iz * (v(0) - x * v(2)) - x * y * v(3) + (1 + x * x) * v(4) - y * v(5);
      const float along_y = iz * (v(1) - y * v(2)) - (1 + y * y) * v(3) + x * y * v(4) + x * v(5);
      increment[column] = fx * slope_x[column] * along_x + fy * slope_y[column] * along_y;
    }
  }
}

float IncrementTemplate::measure_steepness() {
  double sum = 0;
  double known = 0;
  const int stride = camera_.width;
  for (int y = 1; y + 1 < camera_.height; ++y) {
    const float* depth = &inverse_depth_(0, y);
    const float* row = &increment_(0, y);
    float* steepness = &steepness_(0, y);
    for (int x = 1; x + 1 < camera_.width; ++x) {
      const bool is_known = (depth[x] > 0) & (depth[x - 1] > 0) & (depth[x + 1] > 0) &
                            (depth[x - stride] > 0) & (depth[x + stride] > 0);
      const float gx = 0.5F * (row[x + 1] - row[x - 1]);
      const float gy = 0.5F * (row[x + stride] - row[x - stride]);
      steepness[x] = is_known ? gx * gx + gy * gy : -1;
    }
    for (int x = 1; x + 1 < camera_.width; ++x) {
      sum += steepness[x] >= 0 ? static_cast<double>(steepness[x]) : 0;
      known += steepness[x] >= 0 ? 1 : 0;
    }
  }
  return static_cast<float>(known > 0 ? sum / known : 0);
}

const IncrementPoints& IncrementTemplate::points(const Twist& velocity, double min_slope) {
  expect_increments(velocity);
  const float least = static_cast<float>(min_slope * min_slope) * measure_steepness();
  points_.count = 0;
  for (int y = 1; y + 1 < camera_.height; ++y)
    for (int x = 1; x + 1 < camera_.width; ++x)
      if (steepness_(x, y) >= least) add_point(x, y);
  return points_;
}

void IncrementTemplate::add_point(int column, int row) {
  const auto x = static_cast<float>((column - camera_.cx) / camera_.fx);
  const auto y = static_cast<float>((row - camera_.cy) / camera_.fy);
  const float iz = inverse_depth_(column, row);
  const auto fx = static_cast<float>(camera_.fx);
  const auto fy = static_cast<float>(camera_.fy);
  const float a = 0.5F * fx * (increment_(column + 1, row) - increment_(column - 1, row));
  const float b = 0.5F * fy * (increment_(column, row + 1) - increment_(column, row - 1));
  const float radial = a * x + b * y;
  const std::size_t i = points_.count++;
  points_.ray_x[i] = x;
  points_.ray_y[i] = y;
  points_.inverse_depth[i] = iz;
  points_.increment[i] = increment_(column, row);
  points_.slope[i] = std::sqrt(steepness_(column, row));
  points_.by_pose[0][i] = a * iz;
  points_.by_pose[1][i] = b * iz;
  points_.by_pose[2][i] = -radial * iz;
  points_.by_pose[3][i] = -y * radial - b;
  points_.by_pose[4][i] = x * radial + a;
  points_.by_pose[5][i] = b * x - a * y;
}

}  // namespace saccade
