#include "estimator/edges/window/coarse_surface.h"

#include <ceres/sized_cost_function.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace saccade {
namespace {

/// (b - a) / sigma.
class DifferenceCost : public ceres::SizedCostFunction<1, 1, 1> {
 public:
  explicit DifferenceCost(double sigma) : sigma_(sigma) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    residuals[0] = (parameters[1][0] - parameters[0][0]) / sigma_;
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) jacobians[0][0] = -1 / sigma_;
    if (jacobians[1] != nullptr) jacobians[1][0] = 1 / sigma_;
    return true;
  }

 private:
  double sigma_;
};

/// Equal steps of at most `spacing_px` over 0..size - 1, at least one.
int steps_over(int size, double spacing_px) {
  return std::max(1, static_cast<int>(std::ceil((size - 1) / spacing_px)));
}

}  // namespace

CoarseSurface::CoarseSurface(const PinholeCamera& camera, double spacing_px, double inverse_depth)
    : columns_(steps_over(camera.width, spacing_px) + 1),
      rows_(steps_over(camera.height, spacing_px) + 1),
      step_x_px_(std::max(1, camera.width - 1) / (columns_ - 1.0)),
      step_y_px_(std::max(1, camera.height - 1) / (rows_ - 1.0)),
      inverse_depth_(inverse_depth),
      nodes_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), inverse_depth) {}

double* CoarseSurface::node(int x, int y) {
  return &nodes_[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
                 static_cast<std::size_t>(x)];
}

auto CoarseSurface::cell_at(const Eigen::Vector2d& pixel) const -> Cell {
  const double x = std::clamp(pixel.x() / step_x_px_, 0.0, columns_ - 1.0);
  const double y = std::clamp(pixel.y() / step_y_px_, 0.0, rows_ - 1.0);
  const int left = std::min(static_cast<int>(x), columns_ - 2);
  const int top = std::min(static_cast<int>(y), rows_ - 2);
  const double a = x - left, b = y - top;
  const auto first = static_cast<std::size_t>(top) * static_cast<std::size_t>(columns_) +
                     static_cast<std::size_t>(left);
  const auto below = first + static_cast<std::size_t>(columns_);
  return {{first, first + 1, below, below + 1},
          {(1 - a) * (1 - b), a * (1 - b), (1 - a) * b, a * b}};
}

void CoarseSurface::add_to(WindowBundle& bundle) {
  // Row by row: an edge couples two of them, and the whole surface of a large sensor has thousands of
  // nodes.
  for (int y = 0; y < rows_; ++y) bundle.keep({node(0, y), static_cast<std::size_t>(columns_)});
  const double sigma = kRoughness * inverse_depth_;
  for (int y = 0; y < rows_; ++y)
    for (int x = 0; x < columns_; ++x) {
      if (x > 0)
        bundle.add_factor(std::make_unique<DifferenceCost>(sigma), {node(x - 1, y), node(x, y)});
      if (y > 0)
        bundle.add_factor(std::make_unique<DifferenceCost>(sigma), {node(x, y - 1), node(x, y)});
    }
}

WindowBundle::SurfaceLink CoarseSurface::link(const Eigen::Vector2d& pixel, double sigma) {
  const Cell cell = cell_at(pixel);
  return {{&nodes_[cell.nodes[0]], &nodes_[cell.nodes[1]], &nodes_[cell.nodes[2]],
           &nodes_[cell.nodes[3]]},
          cell.weights,
          sigma * inverse_depth_};
}

}  // namespace saccade
