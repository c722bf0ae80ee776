#include "estimator/reconstruction/observations/reference_grid.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/check.h"
#include "estimator/reconstruction/observations/reprojector.h"

namespace saccade {

ReferenceGrid::ReferenceGrid(ImageF inverse_depth) : inverse_depth_(std::move(inverse_depth)) {
  SACCADE_CHECK(width() > 1 && height() > 1);
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

ReferenceGrid::ReferenceGrid(const Panorama& panorama)
    : ReferenceGrid(ImageF(panorama.width, panorama.height, 1)) {
  wraps_ = panorama.wraps();
  for (int y = 0; y < panorama.height; ++y)
    row_width_.push_back(static_cast<float>(panorama.row_width(y)));
}

int ReferenceGrid::right_of(int x, int y) const {
  if (x + 1 < width()) return y * width() + x + 1;
  return wraps_ ? y * width() : -1;
}

int ReferenceGrid::below(int x, int y) const {
  return y + 1 < height() ? (y + 1) * width() + x : -1;
}

GridPoint ReferenceGrid::at_seam(float x, float y) const {
  const BilinearCell<float> c(0.0F, y, width(), height());
  const int left = c.y0 * width() + width() - 1, right = c.y0 * width();
  const float fx = std::min(x - static_cast<float>(width() - 1), 1.0F);
  return {{left, right, left + width(), right + width()},
          {(1 - fx) * (1 - c.fy), fx * (1 - c.fy), (1 - fx) * c.fy, fx * c.fy}};
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
  return std::abs(a - b) <= static_cast<float>(kSameSurfaceRatio) * std::max(a, b);
}

}  // namespace saccade
