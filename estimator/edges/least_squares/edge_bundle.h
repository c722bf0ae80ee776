#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <ceres/cost_function.h>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/rigid3.h"
#include "estimator/edges/least_squares/cost_log.h"
#include "estimator/edges/least_squares/edge_rows.h"
#include "estimator/edges/least_squares/kept_unknowns.h"

namespace saccade {

/// Bundle adjustment of a camera's path and of the edges that it sees (Triggs et al., 2000): the
/// least-squares problem that a window of odometry, a whole path and their start have in common,
/// described apart from who solves it. It minimises
///   1/2 sum of a^2 ln(1 + (r / (a sigma))^2)       over the events, r of edge_residual.h
///     + Gaussian or robust priors on each edge's unknowns
///     + factors of the kept unknowns alone, among them the priors on the path,
/// with a = EdgeNoise::kCauchyScale. The kept unknowns are those of the path, six for each twist,
/// and others that factors name; those of an edge are eliminated, since no residual has two edges.
/// `kSupport` neighbouring twists move an event: 2 of a path linear between nodes, 4 of a cubic
/// spline. `kUnknowns` of an edge: 4, or 5 with the spacing of a polarity run's events.
/// The unknowns themselves lie with the caller, and outlive the bundle.
template <int kSupport, int kUnknowns>
class EdgeBundle {
 public:
  using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
  using Event = BundleEvent<kSupport>;

  /// Independent Gaussians. `is_robust`: with Cauchy's loss on (rho, c) and on (m, h); k has none.
  struct Prior {
    Unknowns mean, sigma;
    bool is_robust = false;
  };
  /// That an edge's inverse depth is sum_k weight_k node_k, with Cauchy's loss beyond a sigma; the
  /// nodes are kept unknowns.
  struct SurfaceLink {
    std::array<double*, 4> nodes;
    std::array<double, 4> weights;
    double sigma = 1;
  };
  struct Edge {
    Eigen::Vector2d pixel, normal;
    double* unknowns;  ///< kUnknowns
    Prior prior;
    std::optional<SurfaceLink> link;
    std::size_t first_lanes = 0, last_lanes = 0;  ///< its events, among all lanes
  };

  /// `camera` is undistorted; `path` holds six numbers for each twist, one after the other.
  EdgeBundle(const PinholeCamera& camera, std::span<double> path) : camera_(camera), path_(path) {
    kept_.push_back(path);
  }

  /// Kept unknowns beside the path: factors and links may name any of them.
  void keep(std::span<double> unknowns) { kept_.push_back(unknowns); }

  /// Room for edges with these events.
  void reserve(std::span<const std::vector<Event>> events_of_edges) {
    std::size_t lanes = 0;
    for (const std::vector<Event>& events : events_of_edges)
      lanes += (events.size() + kEventLanes - 1) / kEventLanes;
    edges_.reserve(edges_.size() + events_of_edges.size());
    lanes_.reserve(lanes_.size() + lanes);
  }

  /// An edge; the events that are observed from now on are its own.
  void add_edge(const Eigen::Vector2d& pixel, const Eigen::Vector2d& normal, double* unknowns,
                const Prior& prior, std::optional<SurfaceLink> link = {}) {
    edges_.push_back(
        {pixel, normal, unknowns, prior, std::move(link), lanes_.size(), lanes_.size()});
    next_lane_ = kEventLanes;
  }

  /// An event of the edge that was added last, with its pixel and normal. Left out, and false,
  /// where the ray leads away from the edge's view as the unknowns are now.
  bool add_event(const Event& event) {
    Edge& edge = edges_.back();
    const EdgeLine line = line_of(event.observation, camera_);
    if (!(line.forward > 0 && line.magnification(edge.unknowns[0]) > 0)) return false;
    if (next_lane_ == kEventLanes) {
      lanes_.emplace_back();
      ++edge.last_lanes;
      next_lane_ = 0;
    }
    lanes_.back().set(next_lane_++, event);
    ++events_;
    return true;
  }

  /// Of kept unknowns alone, without a loss.
  void add_factor(std::unique_ptr<ceres::CostFunction> cost, std::vector<double*> blocks) {
    factors_.push_back({std::move(cost), std::move(blocks)});
  }

  [[nodiscard]] const PinholeCamera& camera() const { return camera_; }
  [[nodiscard]] std::span<double> path() const { return path_; }
  /// The path's unknowns first.
  [[nodiscard]] std::span<const std::span<double>> kept() const { return kept_; }
  [[nodiscard]] std::span<const Edge> edges() const { return edges_; }
  [[nodiscard]] std::span<const EventLanes<kSupport>> lanes() const { return lanes_; }
  [[nodiscard]] std::span<const KeptFactor> factors() const { return factors_; }
  [[nodiscard]] std::size_t events() const { return events_; }

  [[nodiscard]] static EdgeState<kUnknowns> state(const Edge& edge, const Unknowns& unknowns) {
    return {edge.pixel, edge.normal, unknowns};
  }

  /// The events' residuals as the unknowns are now: over their sigma, with the sigma [px]. Those
  /// whose ray leads away are left out.
  void for_each_residual(const std::function<void(double residual, double sigma_px)>& visit) const {
    for (const Edge& edge : edges_) {
      const auto now = state(edge, Eigen::Map<const Unknowns>(edge.unknowns));
      for (std::size_t i = edge.first_lanes; i < edge.last_lanes; ++i) {
        DoubleLanes residuals;
        const bool is_whole =
            event_residuals(lanes_[i], now, camera_, motion_of(lanes_[i], path_), residuals);
        for (std::size_t lane = 0; lane < kEventLanes; ++lane)
          if (lanes_[i].holds(lane) && (is_whole || std::isfinite(residuals[lane])))
            visit(residuals[lane], 1 / lanes_[i].inverse_sigma[lane]);
      }
    }
  }

 private:
  PinholeCamera camera_;
  std::span<double> path_;
  std::vector<std::span<double>> kept_;
  std::vector<Edge> edges_;
  std::vector<EventLanes<kSupport>> lanes_;
  std::vector<KeptFactor> factors_;
  std::size_t next_lane_ = kEventLanes;
  std::size_t events_ = 0;
};

using WindowBundle = EdgeBundle<2, 4>;
using PathBundle = EdgeBundle<4, 5>;

/// Who solves a bundle: solve_bundle() itself, or Ceres as its reference.
enum class BundleSolver { kStructured, kCeres };

/// When a solver ends.
struct BundleSolverOptions {
  int iterations = 10;           ///< at most
  double tolerance = 1e-6;       ///< of the cost's relative change
  std::function<void()> each{};  ///< called after every iteration, if set
};

}  // namespace saccade
