#include "estimator/depth/outlier_removal.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/check.h"

namespace saccade {
namespace {

/// Points by the square of the image that they lie in; what lies outside of the image counts to the
/// squares at its border.
class ImageSquares {
 public:
  ImageSquares(const std::vector<EdgePoint>& points, const PinholeCamera& camera)
      : columns_(camera.width / kSide_px + 1), rows_(camera.height / kSide_px + 1) {
    squares_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
    for (std::size_t i = 0; i < points.size(); ++i)
      square(column(points[i].x_px), row(points[i].y_px)).push_back(i);
  }

  /// Calls `visit` with the index of each point within `reach` pixels of a place, and with some
  /// beyond, until it returns false.
  template <class Visit>
  void visit_around(const EdgePoint& place, double reach, const Visit& visit) const {
    for (int r = row(place.y_px - reach); r <= row(place.y_px + reach); ++r)
      for (int c = column(place.x_px - reach); c <= column(place.x_px + reach); ++c)
        for (const std::size_t i : square(c, r))
          if (!visit(i)) return;
  }

 private:
  static constexpr int kSide_px = 8;  ///< about a fourth of the usual reach

  [[nodiscard]] static int cell(double px, int count) {
    return static_cast<int>(std::clamp(std::floor(px / kSide_px), 0.0, count - 1.0));
  }
  [[nodiscard]] int column(double x_px) const { return cell(x_px, columns_); }
  [[nodiscard]] int row(double y_px) const { return cell(y_px, rows_); }
  [[nodiscard]] const std::vector<std::size_t>& square(int c, int r) const {
    return squares_[static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_) +
                    static_cast<std::size_t>(c)];
  }
  [[nodiscard]] std::vector<std::size_t>& square(int c, int r) {
    return squares_[static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_) +
                    static_cast<std::size_t>(c)];
  }

  int columns_, rows_;
  std::vector<std::vector<std::size_t>> squares_;
};

}  // namespace

std::vector<EdgePoint> without_outliers(const std::vector<EdgePoint>& points,
                                        const PinholeCamera& camera, double radius_ratio,
                                        int min_neighbours) {
  SACCADE_CHECK(radius_ratio < 1);
  std::vector<Eigen::Vector3d> positions;
  positions.reserve(points.size());
  for (const EdgePoint& point : points)
    positions.emplace_back(camera.ray({point.x_px, point.y_px}) /
                           static_cast<double>(point.inverse_depth));
  const ImageSquares squares(points, camera);
  std::vector<EdgePoint> kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double radius = radius_ratio * positions[i].z();
    // What is within the radius q of a point with the ray (s, 1), both over the depth, is seen at
    //   (s + q_xy) / (1 + q_z), that is within |q| (1 + |s|) / (1 - |q|) of s.
    const double slope = camera.ray({points[i].x_px, points[i].y_px}).head<2>().norm();
    const double reach =
        std::max(camera.fx, camera.fy) * radius_ratio * (1 + slope) / (1 - radius_ratio);
    int neighbours = 0;
    const auto count = [&](std::size_t j) {
      if (j != i && (positions[j] - positions[i]).squaredNorm() <= radius * radius) ++neighbours;
      return neighbours < min_neighbours;
    };
    if (min_neighbours > 0) squares.visit_around(points[i], reach, count);
    if (neighbours >= min_neighbours) kept.push_back(points[i]);
  }
  return kept;
}

}  // namespace saccade
