#include "estimator/edges/least_squares/ceres_bundle.h"

#include <cmath>
#include <memory>

#include <ceres/ceres.h>

#include "estimator/edges/edge_noise.h"
#include "estimator/edges/least_squares/jacobian_block.h"
#include "estimator/edges/least_squares/prior_cost.h"
#include "estimator/edges/least_squares/schur_solver.h"

namespace saccade {
namespace {

/// One event against its edge, over its sigma. Parameters: the path's twists that move it, the
/// edge's unknowns.
template <int kSupport, int kUnknowns>
class EventCost : public ceres::CostFunction {
 public:
  /// `camera` outlives this.
  EventCost(const BundleEvent<kSupport>& event, const PinholeCamera& camera)
      : event_(event), camera_(camera) {
    set_num_residuals(1);
    mutable_parameter_block_sizes()->assign(kSupport, 6);
    mutable_parameter_block_sizes()->push_back(kUnknowns);
  }

  /// False where the ray leads away from the edge's view.
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const Eigen::Map<const Eigen::Matrix<double, kUnknowns, 1>> unknowns(parameters[kSupport]);
    EdgeUnknowns edge = unknowns.template head<4>();
    if constexpr (kUnknowns == 5) edge[1] += event_.run_offset * unknowns[4];
    Twist twist = Twist::Zero();
    for (int k = 0; k < kSupport; ++k)
      twist += event_.weight[k] * Eigen::Map<const Twist>(parameters[k]);
    EdgeDerivatives by;
    residuals[0] = edge_residual(event_.observation, camera_, twist, edge,
                                 jacobians != nullptr ? &by : nullptr) /
                   event_.sigma_px;
    if (!std::isfinite(residuals[0])) return false;
    if (jacobians == nullptr) return true;
    for (int k = 0; k < kSupport; ++k)
      write_block(jacobians[k], event_.weight[k] / event_.sigma_px * by.motion);
    Eigen::Matrix<double, 1, kUnknowns> by_unknowns;
    by_unknowns.template head<4>() = by.edge;
    if constexpr (kUnknowns == 5) by_unknowns[4] = event_.run_offset * by.edge[1];
    write_block(jacobians[kSupport], by_unknowns / event_.sigma_px);
    return true;
  }

 private:
  BundleEvent<kSupport> event_;
  const PinholeCamera& camera_;
};

/// (rho - sum_k weight_k node_k) / sigma. Parameters: the edge's unknowns, four nodes.
class LinkCost : public ceres::CostFunction {
 public:
  LinkCost(int edge_size, const std::array<double, 4>& weights, double sigma)
      : edge_size_(edge_size), weights_(weights), sigma_(sigma) {
    set_num_residuals(1);
    *mutable_parameter_block_sizes() = {edge_size, 1, 1, 1, 1};
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    residuals[0] = parameters[0][0] / sigma_;
    for (std::size_t k = 0; k < 4; ++k) residuals[0] -= weights_[k] * parameters[k + 1][0] / sigma_;
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) {
      std::fill_n(jacobians[0], edge_size_, 0.0);
      jacobians[0][0] = 1 / sigma_;
    }
    for (std::size_t k = 0; k < 4; ++k)
      if (jacobians[k + 1] != nullptr) jacobians[k + 1][0] = -weights_[k] / sigma_;
    return true;
  }

 private:
  int edge_size_;
  std::array<double, 4> weights_;
  double sigma_;
};

template <int kSupport, int kUnknowns>
class CeresBundle {
  using Bundle = EdgeBundle<kSupport, kUnknowns>;

 public:
  explicit CeresBundle(Bundle& bundle) : bundle_(bundle), problem_(without_ownership()) {
    for (const auto& edge : bundle.edges()) add(edge);
    for (const KeptFactor& factor : bundle.factors())
      problem_.AddResidualBlock(factor.cost.get(), nullptr, factor.blocks);
    order_kept();
  }

  SolverSummary solve(const BundleSolverOptions& options) {
    return solve_by_schur(problem_, ordering_, options.iterations, options.tolerance, options.each);
  }

 private:
  /// The bundle owns its factors; what is made here is owned by this.
  static ceres::Problem::Options without_ownership() {
    ceres::Problem::Options options;
    options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    return options;
  }

  void add_cost(std::unique_ptr<ceres::CostFunction> cost, ceres::LossFunction* loss,
                const std::vector<double*>& blocks) {
    problem_.AddResidualBlock(cost.get(), loss, blocks);
    costs_.push_back(std::move(cost));
  }

  void add(const typename Bundle::Edge& edge) {
    for (std::size_t i = edge.first_lanes; i < edge.last_lanes; ++i)
      for (std::size_t lane = 0; lane < kEventLanes; ++lane) {
        if (!bundle_.lanes()[i].holds(lane)) continue;
        const auto event = bundle_.lanes()[i].event(lane, edge.pixel, edge.normal);
        std::vector<double*> blocks;
        for (std::size_t k = 0; k < kSupport; ++k)
          blocks.push_back(bundle_.path().data() + 6 * (event.first + k));
        blocks.push_back(edge.unknowns);
        add_cost(std::make_unique<EventCost<kSupport, kUnknowns>>(event, bundle_.camera()),
                 new ceres::CauchyLoss(EdgeNoise::kCauchyScale), blocks);
      }
    add_prior(edge);
    if (edge.link)
      add_cost(std::make_unique<LinkCost>(kUnknowns, edge.link->weights, edge.link->sigma),
               new ceres::CauchyLoss(1),
               {edge.unknowns, edge.link->nodes[0], edge.link->nodes[1], edge.link->nodes[2],
                edge.link->nodes[3]});
    ordering_->AddElementToGroup(edge.unknowns, 0);
  }

  void add_prior(const typename Bundle::Edge& edge) {
    const Eigen::Matrix<double, kUnknowns, kUnknowns> root =
        root_of_sigma<kUnknowns>(edge.prior.sigma);
    if (!edge.prior.is_robust) {
      add_cost(std::make_unique<LinearPriorCost<kUnknowns>>(root, edge.prior.mean), nullptr,
               {edge.unknowns});
      return;
    }
    for (const int first : {0, 2})
      add_cost(std::make_unique<LinearPriorCost<kUnknowns, 2>>(root.template middleRows<2>(first),
                                                               edge.prior.mean),
               new ceres::CauchyLoss(EdgeNoise::kCauchyScale), {edge.unknowns});
    if constexpr (kUnknowns == 5)
      add_cost(
          std::make_unique<LinearPriorCost<5, 1>>(root.template bottomRows<1>(), edge.prior.mean),
          nullptr, {edge.unknowns});
  }

  /// The path's twists behind the edges, and all others behind them: within a group Ceres orders by
  /// address, which is that of one array for the path.
  void order_kept() {
    std::vector<double*> blocks;
    problem_.GetParameterBlocks(&blocks);
    const std::span<double> path = bundle_.path();
    for (double* block : blocks) {
      if (ordering_->IsMember(block)) continue;
      const bool is_twist = block >= path.data() && block < path.data() + path.size();
      ordering_->AddElementToGroup(block, is_twist ? 1 : 2);
    }
  }

  Bundle& bundle_;
  std::vector<std::unique_ptr<ceres::CostFunction>> costs_;
  ceres::Problem problem_;
  std::shared_ptr<ceres::ParameterBlockOrdering> ordering_ =
      std::make_shared<ceres::ParameterBlockOrdering>();
};

}  // namespace

template <int kSupport, int kUnknowns>
SolverSummary solve_bundle_by_ceres(EdgeBundle<kSupport, kUnknowns>& bundle,
                                    const BundleSolverOptions& options) {
  return CeresBundle<kSupport, kUnknowns>(bundle).solve(options);
}

template SolverSummary solve_bundle_by_ceres(WindowBundle&, const BundleSolverOptions&);
template SolverSummary solve_bundle_by_ceres(PathBundle&, const BundleSolverOptions&);

}  // namespace saccade
