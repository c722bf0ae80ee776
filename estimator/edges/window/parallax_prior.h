#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/rigid3.h"

namespace saccade {

/// How free the depths are that an adjustment finds beside a path.
struct DepthFreedom {
  double edge_sigma = 0;     ///< of an edge from its surface, relative to the typical inverse depth
  double surface_sigma = 0;  ///< of a node of the surface, likewise
  double edges_per_node = 1;
};

/// What one edge saw between two nodes of a path.
struct NodeSighting {
  int node = 0;         ///< the earlier
  double fraction = 0;  ///< of the later, 0..1
};

/// The most probable path and depths together are those of too much parallax p: the more of it there
/// is, the more noise is explained by depths that are free to vary, of which there are more than
/// unknowns of the path (Neyman and Scott, Econometrica 1948). With the depths integrated out, the
/// posterior of the path alone has for every edge of noise sigma the term
///   1/2 ln(1 + s^2 I) + 1/(2 n) ln(1 + n S^2 I),   I = sum over its events of p^2 / (2 sigma^2),
/// s and S the sigmas of the edge and of its node of the surface, which n edges share. Its gradient is that of
/// a Gaussian prior on the parallax of each node about 0, whose information this adds up; it
/// depends on the parallax, so that it is for one step of an iteration.
class ParallaxPrior {
 public:
  /// `view_from_camera` at every node, at least two; parallax counts at `typical_depth_m` > 0.
  ParallaxPrior(const PinholeCamera& camera, double typical_depth_m,
                std::vector<Rigid3> view_from_camera, const DepthFreedom& freedom);

  /// An edge whose events scatter by `sigma_px` > 0.
  void add_edge(std::span<const NodeSighting> events, double sigma_px);

  /// The prior on the correction T exp(xi) of a node: its mean, and a root of its information.
  struct OnNode {
    Twist mean = Twist::Zero();
    Matrix6 root = Matrix6::Zero();
  };
  [[nodiscard]] OnNode on_node(int node) const;
  /// Of the parallax of a node about 0 [1/px^2]; a quarter of what independent depths would give.
  [[nodiscard]] double information(int node) const {
    return information_[static_cast<std::size_t>(node)];
  }

 private:
  DepthFreedom freedom_;
  Eigen::Vector3d px_per_m_;  ///< RMS over the view
  std::vector<Rigid3> view_from_camera_;
  std::vector<double> parallax2_px2_;  ///< p^2 of every node
  std::vector<double> information_;
};

}  // namespace saccade
