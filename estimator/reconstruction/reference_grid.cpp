#include "estimator/reconstruction/reference_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/check.h"

namespace saccade {

ReferenceGrid::ReferenceGrid(ImageF inverse_depth, int scale, double same_surface)
    : inverse_depth_(std::move(inverse_depth)),
      scale_(scale),
      same_surface_(static_cast<float>(same_surface)) {
  SACCADE_CHECK(scale >= 1 && width() > 1 && height() > 1);
  is_one_surface_ = ImageU8(width(), height());
  for (int y = 0; y + 1 < height(); ++y)
    for (int x = 0; x + 1 < width(); ++x) {
      const int i = y * width() + x;
      const std::array<int, 4> corner = {i, i + 1, i + width(), i + width() + 1};
      bool joined = true;
      for (const int a : corner)
        for (const int b : corner) joined = joined && is_joined(a, b);
      is_one_surface_(x, y) = joined ? 1 : 0;
    }
}

void ReferenceGrid::keep_one_surface(GridPoint& point) const {
  const auto largest = std::max_element(point.weight.begin(), point.weight.end());
  const int nearest = point.index[static_cast<std::size_t>(largest - point.weight.begin())];
  float sum = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    if (!is_joined(point.index[k], nearest)) point.weight[k] = 0;
    sum += point.weight[k];
  }
  for (float& weight : point.weight) weight /= sum;
}

bool ReferenceGrid::is_joined(int i, int j) const {
  const float a = inverse_depth_.pixels()[static_cast<std::size_t>(i)];
  const float b = inverse_depth_.pixels()[static_cast<std::size_t>(j)];
  return std::abs(a - b) <= same_surface_ * std::max(a, b);
}

}  // namespace saccade
