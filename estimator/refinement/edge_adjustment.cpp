#include "estimator/refinement/edge_adjustment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include <ceres/ceres.h>

#include "estimator/refinement/edge_residual.h"

namespace saccade {
namespace {

constexpr std::size_t kLeastEdges = 30;
constexpr int kNodeSize = 6;
constexpr int kEdgeSize = 4;

/// An edge with the events that speak for it.
struct ChosenEdge {
  std::size_t index;  ///< in RayEdges
  std::vector<std::uint32_t> events;
};

/// Every n-th of a list, n so that at most `most` remain.
template <class T>
std::vector<T> thinned(const std::vector<T>& all, std::size_t most) {
  if (all.size() <= most) return all;
  std::vector<T> some;
  some.reserve(most);
  for (std::size_t i = 0; i < most; ++i) some.push_back(all[i * all.size() / most]);
  return some;
}

std::vector<ChosenEdge> choose(const RayEdges& edges, const AdjustmentOptions& options) {
  std::vector<std::size_t> indices(edges.edges.size());
  for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = i;
  std::vector<ChosenEdge> chosen;
  for (const std::size_t i : thinned(indices, static_cast<std::size_t>(options.edges))) {
    const FittedEdge& edge = edges.edges[i];
    std::vector<std::uint32_t> events(edges.events.event.begin() + edge.first,
                                      edges.events.event.begin() + edge.last);
    std::sort(events.begin(), events.end());
    chosen.push_back({i, thinned(events, static_cast<std::size_t>(options.events_per_edge))});
  }
  return chosen;
}

/// The correction of the path over time.
class Nodes {
 public:
  Nodes(double start_s, double end_s, double spacing_s)
      : start_s_(start_s),
        count_(std::max(2, 1 + static_cast<int>(std::lround((end_s - start_s) / spacing_s)))),
        spacing_s_((end_s - start_s) / (count_ - 1)),
        corrections_(static_cast<std::size_t>(count_)) {
    for (auto& correction : corrections_) correction.fill(0);
  }
  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] double time_s(int i) const { return start_s_ + i * spacing_s_; }
  [[nodiscard]] double* data(int i) { return corrections_[static_cast<std::size_t>(i)].data(); }
  /// The node before a time, and the share of the one after it.
  [[nodiscard]] std::pair<int, double> before(double t_s) const {
    const double at = std::clamp((t_s - start_s_) / spacing_s_, 0.0, count_ - 1.0);
    const int i = std::min(static_cast<int>(at), count_ - 2);
    return {i, at - i};
  }
  [[nodiscard]] Twist at(double t_s) const {
    const auto [i, share] = before(t_s);
    const auto twist = [&](int k) {
      return Eigen::Map<const Twist>(corrections_[static_cast<std::size_t>(k)].data());
    };
    return (1 - share) * twist(i) + share * twist(i + 1);
  }

 private:
  double start_s_;
  int count_;
  double spacing_s_;
  std::vector<std::array<double, kNodeSize>> corrections_;
};

/// A derivative as Ceres wants it, by rows.
template <int kRows, int kColumns>
void write(double* target, const Eigen::Matrix<double, kRows, kColumns>& derivative) {
  Eigen::Map<Eigen::Matrix<double, kRows, kColumns, Eigen::RowMajor>> map(target);
  map = derivative;
}

/// One event: two nodes and an edge.
class EventCost : public ceres::SizedCostFunction<1, kNodeSize, kNodeSize, kEdgeSize> {
 public:
  EventCost(const EdgeObservation& observation, const PinholeCamera& camera, double share,
            double weight)
      : observation_(observation), camera_(camera), share_(share), weight_(weight) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const Twist motion = (1 - share_) * Eigen::Map<const Twist>(parameters[0]) +
                         share_ * Eigen::Map<const Twist>(parameters[1]);
    const Eigen::Map<const EdgeUnknowns> edge(parameters[2]);
    EdgeDerivatives derivatives;
    residuals[0] = weight_ * edge_residual(observation_, camera_, motion, edge,
                                           jacobians != nullptr ? &derivatives : nullptr);
    if (!std::isfinite(residuals[0])) return false;
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr)
      write<1, kNodeSize>(jacobians[0], weight_ * (1 - share_) * derivatives.motion);
    if (jacobians[1] != nullptr)
      write<1, kNodeSize>(jacobians[1], weight_ * share_ * derivatives.motion);
    if (jacobians[2] != nullptr) write<1, kEdgeSize>(jacobians[2], weight_ * derivatives.edge);
    return true;
  }

 private:
  EdgeObservation observation_;
  PinholeCamera camera_;
  double share_, weight_;
};

/// (x_k - mean_k) / sigma_k; a sigma of infinity holds nothing.
template <int kSize>
class PriorCost : public ceres::SizedCostFunction<kSize, kSize> {
 public:
  using Vector = Eigen::Matrix<double, kSize, 1>;
  PriorCost(const Vector& mean, const Vector& sigma)
      : mean_(mean), precision_(sigma.cwiseInverse()) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const Eigen::Map<const Vector> x(parameters[0]);
    Eigen::Map<Vector>(residuals, kSize) = precision_.cwiseProduct(x - mean_);
    if (jacobians != nullptr && jacobians[0] != nullptr)
      write<kSize, kSize>(jacobians[0], precision_.asDiagonal().toDenseMatrix());
    return true;
  }

 private:
  Vector mean_, precision_;
};

/// The difference of two nodes.
class StepCost : public ceres::SizedCostFunction<kNodeSize, kNodeSize, kNodeSize> {
 public:
  explicit StepCost(const Twist& sigma) : precision_(sigma.cwiseInverse()) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const Eigen::Map<const Twist> a(parameters[0]), b(parameters[1]);
    Eigen::Map<Twist>(residuals, kNodeSize) = precision_.cwiseProduct(b - a);
    if (jacobians == nullptr) return true;
    const Matrix6 by_b = precision_.asDiagonal();
    if (jacobians[0] != nullptr) write<kNodeSize, kNodeSize>(jacobians[0], -by_b);
    if (jacobians[1] != nullptr) write<kNodeSize, kNodeSize>(jacobians[1], by_b);
    return true;
  }

 private:
  Twist precision_;
};

class Problem {
 public:
  Problem(const ViewWindow& window, const RayEdges& edges, const PinholeCamera& camera,
          double typical_depth_m, const AdjustmentOptions& options)
      : window_(window),
        edges_(edges),
        camera_(camera),
        undistorted_(camera.undistorted()),
        options_(options),
        depth_m_(typical_depth_m),
        nodes_(seconds_from_ns(window.events.front().t_ns),
               seconds_from_ns(window.events.back().t_ns), options.node_spacing_s),
        chosen_(choose(edges, options)),
        unknowns_(chosen_.size()) {}

  Adjustment solve(double known_until_s) {
    Adjustment result;
    result.trajectory = *window_.trajectory;
    result.edges = edges_;
    if (chosen_.size() < kLeastEdges) return result;
    add_edges();
    add_nodes(known_until_s);
    result.residual_before_px = deviation_px();
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::DENSE_SCHUR;
    solver.linear_solver_ordering = ordering_;
    solver.max_num_iterations = options_.iterations;
    solver.function_tolerance = 1e-5;
    solver.num_threads = 1;
    solver.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem_, &summary);
    result.residual_after_px = deviation_px();
    result.iterations = static_cast<int>(summary.iterations.size());
    result.ok = summary.IsSolutionUsable();
    if (result.ok) take(result);
    return result;
  }

 private:
  /// Pixels as a motion (v, w).
  [[nodiscard]] Twist sigma_of_px(double px) const {
    Twist sigma;
    sigma.head<3>().setConstant(px * depth_m_ / undistorted_.fx);
    sigma.tail<3>().setConstant(px / undistorted_.fx);
    return sigma;
  }

  void add_edges() {
    const Rigid3 view_from_world = window_.world_from_reference().inverse();
    for (std::size_t k = 0; k < chosen_.size(); ++k) {
      const FittedEdge& fitted = edges_.edges[chosen_[k].index];
      const auto rho = static_cast<double>(fitted.edge.inverse_depth);
      unknowns_[k] = {rho, 0, 0, 0};
      double* unknowns = unknowns_[k].data();
      const double noise_px = std::max(options_.noise_px, static_cast<double>(fitted.residual_px));
      for (const std::uint32_t e : chosen_[k].events) {
        const Event& event = window_.events[e];
        const double t_s = seconds_from_ns(event.t_ns);
        EdgeObservation observation;
        observation.view_from_camera = view_from_world * window_.trajectory->at_clamped(t_s);
        observation.ray = undistorted_.ray(camera_.undistort({event.x, event.y}));
        observation.polarity = event.polarity;
        observation.pixel = fitted.edge.pixel.cast<double>();
        observation.normal = fitted.edge.normal.cast<double>();
        const auto [node, share] = nodes_.before(t_s);
        observations_.push_back({observation, k, t_s});
        problem_.AddResidualBlock(new EventCost(observation, undistorted_, share, 1 / noise_px),
                                  new ceres::CauchyLoss(options_.outlier), nodes_.data(node),
                                  nodes_.data(node + 1), unknowns);
      }
      EdgeUnknowns sigma(std::numeric_limits<double>::infinity(), options_.offset_px,
                         options_.tilt_sigma, options_.hysteresis_px);
      sigma[0] = rho;  // hardly any hold: where a window says nothing of an edge
      problem_.AddResidualBlock(new PriorCost<kEdgeSize>(EdgeUnknowns(rho, 0, 0, 0), sigma),
                                nullptr, unknowns);
      ordering_->AddElementToGroup(unknowns, 0);
    }
  }

  void add_nodes(double known_until_s) {
    const Twist step = sigma_of_px(options_.step_sigma_px);
    for (int i = 0; i < nodes_.count(); ++i) {
      const bool is_known = nodes_.time_s(i) <= known_until_s;
      const Twist sigma = sigma_of_px(is_known ? options_.known_sigma_px : options_.pose_sigma_px);
      problem_.AddResidualBlock(new PriorCost<kNodeSize>(Twist::Zero(), sigma), nullptr,
                                nodes_.data(i));
      if (i > 0)
        problem_.AddResidualBlock(new StepCost(step), nullptr, nodes_.data(i - 1), nodes_.data(i));
      ordering_->AddElementToGroup(nodes_.data(i), 1);
    }
  }

  /// Median of the absolute residuals, as a Gaussian's deviation [px].
  [[nodiscard]] double deviation_px() const {
    std::vector<double> residuals;
    for (const auto& [observation, k, t_s] : observations_)
      residuals.push_back(std::abs(
          edge_residual(observation, undistorted_, nodes_.at(t_s), unknowns_[k], nullptr)));
    const auto middle = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
    std::nth_element(residuals.begin(), middle, residuals.end());
    return 1.4826 * *middle;
  }

  void take(Adjustment& result) const {
    std::vector<StampedPose> poses(window_.trajectory->poses().begin(),
                                   window_.trajectory->poses().end());
    for (StampedPose& pose : poses)
      if (pose.t_s >= nodes_.time_s(0))
        pose.world_from_camera = pose.world_from_camera * Rigid3::exp(nodes_.at(pose.t_s));
    result.trajectory = Trajectory(std::move(poses));
    result.edges.edges.clear();
    for (std::size_t k = 0; k < chosen_.size(); ++k) {
      const EdgeUnknowns& x = unknowns_[k];
      FittedEdge fitted = edges_.edges[chosen_[k].index];
      if (!(x[0] > 0)) continue;
      RayEdge& edge = fitted.edge;
      const Eigen::Vector2f tangent = edge.tangent();
      edge.pixel += static_cast<float>(x[1]) * edge.normal;
      edge.normal = (edge.normal - static_cast<float>(x[2]) * tangent).normalized();
      edge.inverse_depth = static_cast<float>(x[0]);
      result.edges.edges.push_back(fitted);
    }
  }

  struct Observed {
    EdgeObservation observation;
    std::size_t edge;
    double t_s;
  };

  const ViewWindow& window_;
  const RayEdges& edges_;
  const PinholeCamera& camera_;
  PinholeCamera undistorted_;
  AdjustmentOptions options_;
  double depth_m_;
  Nodes nodes_;
  std::vector<ChosenEdge> chosen_;
  std::vector<EdgeUnknowns> unknowns_;
  std::vector<Observed> observations_;
  ceres::Problem problem_;
  std::shared_ptr<ceres::ParameterBlockOrdering> ordering_ =
      std::make_shared<ceres::ParameterBlockOrdering>();
};

}  // namespace

Adjustment adjust(const ViewWindow& window, const RayEdges& edges, const PinholeCamera& camera,
                  double known_until_s, double typical_depth_m, const AdjustmentOptions& options) {
  return Problem(window, edges, camera, typical_depth_m, options).solve(known_until_s);
}

}  // namespace saccade
