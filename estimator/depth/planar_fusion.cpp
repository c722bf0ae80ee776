#include "estimator/depth/planar_fusion.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include <Eigen/Cholesky>

namespace saccade {
namespace {

constexpr float kTukey = 4.685F;
constexpr float kMaxSlope = 0.02F;  ///< relative change of inverse depth per pixel at the start
constexpr double kSlopePrior = 0.01;

/// Points in square cells as wide as the radius.
class PointGrid {
 public:
  PointGrid(const std::vector<EdgeDepth>& points, float cell_px) : cell_px_(cell_px) {
    for (const EdgeDepth& point : points) {
      columns_ = std::max(columns_, column(point.x_px) + 2);
      rows_ = std::max(rows_, column(point.y_px) + 2);
    }
    cells_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
    for (std::size_t i = 0; i < points.size(); ++i)
      cell(column(points[i].x_px), column(points[i].y_px)).push_back(i);
  }

  template <class Visit>
  void for_near(const EdgeDepth& point, const Visit& visit) const {
    const int cx = column(point.x_px), cy = column(point.y_px);
    for (int y = std::max(cy - 1, 0); y <= std::min(cy + 1, rows_ - 1); ++y)
      for (int x = std::max(cx - 1, 0); x <= std::min(cx + 1, columns_ - 1); ++x)
        for (const std::size_t i : cells_[index(x, y)]) visit(i);
  }

 private:
  [[nodiscard]] int column(float px) const {
    return std::max(0, static_cast<int>(px / cell_px_ + 1));
  }
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(x);
  }
  std::vector<std::size_t>& cell(int x, int y) { return cells_[index(x, y)]; }

  float cell_px_;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::vector<std::size_t>> cells_;
};

struct Neighbour {
  float dx, dy;
  float difference;  ///< of inverse depth from the point's own
  float variance;
};

/// The plane's height over the point, relative to the point's own value.
struct Fit {
  Eigen::Vector3f plane = Eigen::Vector3f::Zero();
  float variance = 0;
  float weights = 0;  ///< of the neighbours, the point itself not counted
  float spread = 1;   ///< robust scale of the normalised residuals
};

float residual(const Neighbour& n, const Eigen::Vector3f& plane) {
  return (n.difference - plane.x() - plane.y() * n.dx - plane.z() * n.dy) / std::sqrt(n.variance);
}

float biweight(float u) {
  const float v = std::max(0.F, 1 - u * u);
  return v * v;
}

Fit fit_plane(const std::vector<Neighbour>& near, float own, const FusionOptions& options) {
  Fit fit;
  std::vector<float> sorted(near.size());
  for (int i = 0; i < options.iterations; ++i) {
    for (std::size_t k = 0; k < near.size(); ++k)
      sorted[k] = std::abs(residual(near[k], fit.plane));
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    fit.spread = std::max(1.F, 1.4826F * *middle);
    Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    fit.weights = -1;
    for (const Neighbour& n : near) {
      const float w = biweight(residual(n, fit.plane) / (kTukey * fit.spread));
      const Eigen::Vector3d row(1, static_cast<double>(n.dx), static_cast<double>(n.dy));
      const double information = static_cast<double>(w / n.variance);
      a += information * row * row.transpose();
      b += information * static_cast<double>(n.difference) * row;
      fit.weights += w;
    }
    const double slope = 1 / std::pow(kSlopePrior * static_cast<double>(own), 2);
    a(1, 1) += slope;
    a(2, 2) += slope;
    const Eigen::LDLT<Eigen::Matrix3d> solver(a);
    fit.plane = solver.solve(b).cast<float>();
    fit.variance = static_cast<float>(solver.solve(Eigen::Vector3d::UnitX())(0));
  }
  return fit;
}

std::vector<Neighbour> neighbours_of(const EdgeDepth& point, const std::vector<EdgeDepth>& points,
                                     const PointGrid& grid, const FusionOptions& options) {
  std::vector<Neighbour> near;
  const auto radius = static_cast<float>(options.radius_px);
  grid.for_near(point, [&](std::size_t i) {
    const EdgeDepth& other = points[i];
    const float dx = other.x_px - point.x_px, dy = other.y_px - point.y_px;
    const float distance = std::hypot(dx, dy);
    if (distance > radius) return;
    const float difference = other.inverse_depth - point.inverse_depth;
    if (std::abs(difference) >
        kMaxSlope * distance * point.inverse_depth + 3 * std::hypot(point.sigma, other.sigma))
      return;
    const float model = static_cast<float>(options.model_error) * point.inverse_depth;
    near.push_back({dx, dy, difference, other.sigma * other.sigma + model * model});
  });
  return near;
}

}  // namespace

std::vector<EdgeDepth> fused(const std::vector<EdgeDepth>& points, const FusionOptions& options) {
  if (!(options.radius_px > 0) || points.empty()) return points;
  const PointGrid grid(points, static_cast<float>(options.radius_px));
  std::vector<EdgeDepth> result;
  for (const EdgeDepth& point : points) {
    const auto near = neighbours_of(point, points, grid, options);
    const Fit fit = fit_plane(near, point.inverse_depth, options);
    if (fit.weights < static_cast<float>(options.min_neighbours)) continue;
    if (std::abs(fit.plane.x()) > kTukey * fit.spread * point.sigma + 0.005F * point.inverse_depth)
      continue;
    EdgeDepth smooth = point;
    smooth.inverse_depth += fit.plane.x();
    const auto scale = static_cast<float>(options.sigma_scale) * fit.spread;
    const float common = static_cast<float>(options.floor) * smooth.inverse_depth;
    const float apart = static_cast<float>(options.disagreement) * fit.plane.x();
    smooth.sigma = std::sqrt(scale * scale * fit.variance + common * common + apart * apart);
    if (smooth.inverse_depth > 0) result.push_back(smooth);
  }
  return result;
}

}  // namespace saccade
