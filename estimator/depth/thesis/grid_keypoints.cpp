#include "estimator/depth/thesis/grid_keypoints.h"

#include <numeric>
#include <optional>

namespace saccade {
namespace {

std::optional<Eigen::Vector2f> centre_of_mass(const ImageF& frame, int left, int top, int size,
                                              double min_weight) {
  double weight = 0, x_sum = 0, y_sum = 0;
  for (int y = top; y < top + size; ++y)
    for (int x = left; x < left + size; ++x) {
      const double w = frame(x, y);
      weight += w;
      x_sum += w * x;
      y_sum += w * y;
    }
  if (weight <= 0 || weight < min_weight) return std::nullopt;
  return Eigen::Vector2d(x_sum / weight, y_sum / weight).cast<float>();
}

}  // namespace

std::vector<Eigen::Vector2f> find_keypoints(const ImageF& frame, int cell_px, double min_weight) {
  const auto pixels = frame.pixels();
  const double mean =
      std::accumulate(pixels.begin(), pixels.end(), 0.0) / static_cast<double>(pixels.size());
  const double min_sum = min_weight * mean * cell_px * cell_px;
  std::vector<Eigen::Vector2f> keypoints;
  for (int top = 0; top + cell_px <= frame.height(); top += cell_px)
    for (int left = 0; left + cell_px <= frame.width(); left += cell_px)
      if (const auto centre = centre_of_mass(frame, left, top, cell_px, min_sum))
        keypoints.push_back(*centre);
  return keypoints;
}

}  // namespace saccade
