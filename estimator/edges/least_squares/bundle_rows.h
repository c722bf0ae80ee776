#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/process/parallel.h"
#include "estimator/edges/edge_noise.h"
#include "estimator/edges/least_squares/edge_bundle.h"
#include "estimator/edges/least_squares/kept_unknowns.h"

namespace saccade {

inline constexpr std::size_t kEdgesAtOnce = 64;  ///< that a thread takes

/// A Cauchy loss a^2 ln(1 + s / a^2) of a squared residual s.
[[nodiscard]] inline double cauchy_loss(double squared, double scale) {
  return scale * scale * std::log1p(squared / (scale * scale));
}
/// The root of the weight that iteratively reweighted least squares gives such a residual's row.
[[nodiscard]] inline double cauchy_root_weight(double squared, double scale) {
  return 1 / std::sqrt(1 + squared / (scale * scale));
}

/// Values of a bundle's unknowns.
template <int kUnknowns>
struct BundlePoint {
  using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
  std::vector<double> kept;
  std::vector<Unknowns> edges;

  [[nodiscard]] double norm() const {
    double squares = 0;
    for (const double value : kept) squares += value * value;
    for (const Unknowns& edge : edges) squares += edge.squaredNorm();
    return std::sqrt(squares);
  }
};

/// A bundle's cost, and its residuals with their derivatives, at any point.
template <int kSupport, int kUnknowns>
class BundleRows {
 public:
  using Bundle = EdgeBundle<kSupport, kUnknowns>;
  using Edge = typename Bundle::Edge;
  using Unknowns = typename Bundle::Unknowns;
  using EdgeMatrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;
  using Point = BundlePoint<kUnknowns>;

  /// `bundle` outlives this.
  explicit BundleRows(Bundle& bundle)
      : bundle_(bundle), kept_(bundle.kept(), bundle.factors()), rows_(bundle.lanes().size()) {}

  [[nodiscard]] const Bundle& bundle() const { return bundle_; }
  [[nodiscard]] const KeptUnknowns& kept() const { return kept_; }
  /// Of the events at the point that was linearised last, with the roots of their weights.
  [[nodiscard]] std::span<const RowLanes<kUnknowns>> events() const { return rows_; }

  /// The unknowns as they are with the caller, and back.
  [[nodiscard]] Point point() const {
    Point point{kept_.values(), {}};
    for (const Edge& edge : bundle_.edges())
      point.edges.push_back(Eigen::Map<const Unknowns>(edge.unknowns));
    return point;
  }
  void write(const Point& point) {
    kept_.write(point.kept);
    for (std::size_t e = 0; e < point.edges.size(); ++e)
      Eigen::Map<Unknowns>(bundle_.edges()[e].unknowns) = point.edges[e];
  }

  /// nullopt where a residual cannot be evaluated.
  [[nodiscard]] std::optional<double> cost_at(const Point& point) const {
    const std::size_t count = point.edges.size();
    std::vector<double> costs((count + kEdgesAtOnce - 1) / kEdgesAtOnce, 0);
    parallel_for_ranges(count, kEdgesAtOnce, [&](std::size_t begin, std::size_t end) {
      double& sum = costs[begin / kEdgesAtOnce];
      for (std::size_t i = begin; i < end; ++i) sum += edge_cost(bundle_.edges()[i], point, i);
    });
    const double cost = std::accumulate(costs.begin(), costs.end(), kept_.cost(point.kept));
    return std::isfinite(cost) ? std::optional(cost) : std::nullopt;
  }

  /// The events' rows and the factors at a point where the cost can be evaluated.
  void linearise(const Point& point) {
    linearise_edges(point, 0, point.edges.size());
    kept_.linearise(point.kept);
  }
  /// The rows of the events of the edges first .. last - 1 alone.
  void linearise_edges(const Point& point, std::size_t first, std::size_t last) {
    parallel_for(
        last - first, [&](std::size_t k) { linearise_edge(point, first + k); }, kEdgesAtOnce);
  }

  /// Starts an edge's part of the normal equations with its prior: J^T J and J^T r.
  static void start_with_priors(const Edge& edge, const Unknowns& unknowns, EdgeMatrix& square,
                                Unknowns& gradient) {
    const Unknowns inverse_sigma = edge.prior.sigma.cwiseInverse();
    const Unknowns residual = (unknowns - edge.prior.mean).cwiseProduct(inverse_sigma);
    Unknowns root = Unknowns::Ones();
    if (edge.prior.is_robust)
      for (const int first : {0, 2})
        root.template segment<2>(first).setConstant(cauchy_root_weight(
            residual.template segment<2>(first).squaredNorm(), EdgeNoise::kCauchyScale));
    const Unknowns weight = root.cwiseAbs2();
    square = weight.cwiseProduct(inverse_sigma.cwiseAbs2()).asDiagonal();
    gradient = weight.cwiseProduct(residual).cwiseProduct(inverse_sigma);
  }

  /// An edge's link to a surface: residual and weight. `edge.link` is set.
  struct Link {
    double residual, weight;
  };
  [[nodiscard]] Link link(const Edge& edge, double rho, const Point& point) const {
    double sum = rho;
    for (std::size_t k = 0; k < 4; ++k)
      sum -= edge.link->weights[k] * point.kept[kept_.place(edge.link->nodes[k]).index];
    const double residual = sum / edge.link->sigma;
    const double root = cauchy_root_weight(residual * residual, 1);
    return {residual, root * root};
  }

 private:
  void linearise_edge(const Point& point, std::size_t e) {
    const Edge& edge = bundle_.edges()[e];
    const EdgeState<kUnknowns> state = Bundle::state(edge, point.edges[e]);
    for (std::size_t i = edge.first_lanes; i < edge.last_lanes; ++i) {
      const EventLanes<kSupport>& lanes = bundle_.lanes()[i];
      RowLanes<kUnknowns>& rows = rows_[i];
      // The cost at the point is finite, so that an event whose ray leads away is one by the
      // rounding of its last bit: it is an outlier, and says nothing.
      const bool is_whole =
          event_rows(lanes, state, bundle_.camera(), motion_of(lanes, path_of(point)), rows);
      if (!is_whole) {
        rows = RowLanes<kUnknowns>{};
        continue;
      }
      DoubleLanes weight;
      for (std::size_t lane = 0; lane < kEventLanes; ++lane)
        weight[lane] =
            cauchy_root_weight(rows.residual[lane] * rows.residual[lane], EdgeNoise::kCauchyScale);
      rows.residual *= weight;
      for (DoubleLanes& by : rows.by_motion) by *= weight;
      for (DoubleLanes& by : rows.by_edge) by *= weight;
    }
  }

  [[nodiscard]] std::span<const double> path_of(const Point& point) const {
    return std::span(point.kept).first(bundle_.path().size());
  }

  [[nodiscard]] double edge_cost(const Edge& edge, const Point& point, std::size_t index) const {
    const Unknowns& unknowns = point.edges[index];
    const EdgeState<kUnknowns> state = Bundle::state(edge, unknowns);
    double twice = 0;
    for (std::size_t i = edge.first_lanes; i < edge.last_lanes; ++i) {
      const EventLanes<kSupport>& lanes = bundle_.lanes()[i];
      DoubleLanes residuals;
      if (!event_residuals(lanes, state, bundle_.camera(), motion_of(lanes, path_of(point)),
                           residuals))
        return std::numeric_limits<double>::infinity();
      for (std::size_t lane = 0; lane < kEventLanes; ++lane)
        twice += cauchy_loss(residuals[lane] * residuals[lane], EdgeNoise::kCauchyScale);
    }
    const Unknowns prior = (unknowns - edge.prior.mean).cwiseQuotient(edge.prior.sigma);
    if (edge.prior.is_robust) {
      twice += cauchy_loss(prior.template head<2>().squaredNorm(), EdgeNoise::kCauchyScale);
      twice += cauchy_loss(prior.template segment<2>(2).squaredNorm(), EdgeNoise::kCauchyScale);
      twice += prior.template tail<kUnknowns - 4>().squaredNorm();
    } else {
      twice += prior.squaredNorm();
    }
    if (edge.link) {
      const double residual = link(edge, unknowns[0], point).residual;
      twice += cauchy_loss(residual * residual, 1);
    }
    return twice / 2;
  }

  Bundle& bundle_;
  KeptUnknowns kept_;
  std::vector<RowLanes<kUnknowns>> rows_;
};

}  // namespace saccade
