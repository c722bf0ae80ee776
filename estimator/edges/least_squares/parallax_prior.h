#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/rigid3.h"
#include "estimator/edges/least_squares/edge_rows.h"

namespace saccade {

/// A surface that edges lie on, of nodes whose inverse depth is as free as this.
struct FreeSurface {
  double node_sigma = 0;  ///< of the inverse depth of a node [1/m]; 0: there is no surface
  double edges_per_node = 1;
};

/// The most probable path and depths together are those of too much parallax: the more of it there
/// is, the more noise is explained by depths that are free to vary, of which there are more than
/// unknowns of the path (Neyman and Scott, Econometrica 1948). With the depths integrated out, the
/// posterior of the path alone has for every edge the term
///   1/2 ln(1 + s^2 I) + 1/(2 n) ln(1 + n S^2 I'),
///   I = sum over its events of (p - mean p)^2 / sigma^2,
/// where p is an event's parallax across the edge per inverse depth, s the sigma of the edge's
/// inverse depth before its events, S that of a node of the surface which n edges share, and I' the
/// mean of I over all edges, since those that share a node have several directions. (The mean of p
/// is taken up by the edge's own place, but where a landmark knows that.) Half of the gradient is
/// that of a Gaussian prior on the translation of each twist of the path's correction, which this
/// adds up; its information is an upper bound of the term's own. It is of the parallax that there was
/// when it was taken, and renewed with the edges, not from iteration to iteration.
class ParallaxPrior {
 public:
  /// Of a correction of so many twists; `camera` has no lens.
  ParallaxPrior(const PinholeCamera& camera, std::size_t twists, const FreeSurface& surface)
      : camera_(camera), surface_(surface), twists_(twists) {}

  /// `depth_sigma`: of the edge's inverse depth, from the surface where there is one [1/m].
  /// `events` are its own, whose observations say where it is in its view.
  template <int kSupport>
  void add_edge(double depth_sigma, std::span<const BundleEvent<kSupport>> events) {
    seen_.clear();
    for (const BundleEvent<kSupport>& event : events)
      seen_.push_back(seen_by(event.observation, event.sigma_px));
    const double weight = start_edge(depth_sigma);
    for (std::size_t i = 0; i < events.size(); ++i)
      for (int k = 0; k < kSupport; ++k)
        add_event(seen_[i], weight, events[i].weight[k],
                  events[i].first + static_cast<std::size_t>(k));
  }

  /// The prior on a twist, of all edges that were added: its mean, and a root of its information.
  struct OnTwist {
    Twist mean = Twist::Zero();
    Matrix6 root = Matrix6::Zero();
  };
  [[nodiscard]] OnTwist on(std::size_t twist) const;

 private:
  /// An event of the edge that is added.
  struct Seen {
    double parallax = 0;     ///< p, from its mean [px m]
    Eigen::Vector3d across;  ///< its derivative by the camera's place, in the camera's axes [px]
    double information = 0;  ///< of its position [1/px^2]
  };
  /// About a twist's translation.
  struct Sums {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< [1/m^2]
    Eigen::Vector3d drawn = Eigen::Vector3d::Zero();        ///< that, times the mean [1/m]
    void add(double weight, const Seen& event);
  };
  struct OfTwist {
    Sums edges;    ///< by their own depths
    Sums surface;  ///< by its nodes, which all have one weight
  };

  [[nodiscard]] Seen seen_by(const EdgeObservation& observation, double sigma_px) const;
  /// Takes the mean off the parallaxes, and returns the weight of the edge's events.
  [[nodiscard]] double start_edge(double depth_sigma);
  void add_event(const Seen& event, double edge_weight, double weight, std::size_t twist);
  [[nodiscard]] double surface_weight() const;

  PinholeCamera camera_;
  FreeSurface surface_;
  std::vector<OfTwist> twists_;
  std::size_t edges_ = 0;
  double information_ = 0;  ///< I of all edges [m^2]
  std::vector<Seen> seen_;
};

}  // namespace saccade
