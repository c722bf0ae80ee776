#pragma once

#include <array>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "estimator/edges/least_squares/edge_bundle.h"

namespace saccade {

/// A surface that edges lie on but for outliers: inverse depths at nodes, bilinear in between. An
/// edge alone says how fast it moves across itself, which depth explains whatever the camera does;
/// it is edges of several directions at one depth that distinguish rotation from translation.
class CoarseSurface {
 public:
  /// Sigma of the difference of neighbouring nodes, relative to the surface's inverse depth: it
  /// constrains those that no edge is near to.
  static constexpr double kRoughness = 0.3;

  /// Nodes every `spacing_px` > 0 or less over the camera's view, at `inverse_depth` > 0 [1/m].
  CoarseSurface(const PinholeCamera& camera, double spacing_px, double inverse_depth);

  /// Keeps its nodes among the bundle's unknowns, and adds that they are smooth where no edge says
  /// more.
  void add_to(WindowBundle& bundle);
  /// That an edge at `pixel` of the view lies on it to a relative standard deviation `sigma`.
  [[nodiscard]] WindowBundle::SurfaceLink link(const Eigen::Vector2d& pixel, double sigma);

  /// Inverse depths [1/m], row by row.
  [[nodiscard]] std::span<double> nodes() { return nodes_; }

 private:
  struct Cell {
    std::array<std::size_t, 4> nodes;
    std::array<double, 4> weights;
  };
  [[nodiscard]] Cell cell_at(const Eigen::Vector2d& pixel) const;
  [[nodiscard]] double* node(int x, int y);

  int columns_, rows_;
  double step_x_px_, step_y_px_;
  double inverse_depth_;
  std::vector<double> nodes_;
};

}  // namespace saccade
