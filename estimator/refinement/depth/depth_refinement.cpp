#include "estimator/refinement/depth/depth_refinement.h"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "estimator/edges/edge_noise.h"
#include "estimator/edges/edge_residual.h"
#include "estimator/edges/least_squares/jacobian_block.h"
#include "estimator/edges/least_squares/marginal_information.h"
#include "estimator/edges/least_squares/prior_cost.h"
#include "estimator/edges/least_squares/robust_spread.h"

namespace saccade {
namespace {

constexpr std::size_t kMinEvents = 8;  ///< of an edge
// An edge is that of a point of the run within so much of it, and within this ratio of its inverse
// depth.
constexpr double kNear_px = 1.5, kDepthTolerance = 0.05;
constexpr int kIterations = 20;  ///< of Levenberg-Marquardt, at most
/// Of that of independent residuals: neighbouring events err alike.
constexpr double kInformationRatio = 0.3;

/// One event against the edge alone.
class EdgeCost : public ceres::SizedCostFunction<1, 4> {
 public:
  EdgeCost(const EdgeObservation& observation, const PinholeCamera& camera, double sigma_px)
      : observation_(observation), camera_(camera), sigma_px_(sigma_px) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    EdgeDerivatives by;
    const Eigen::Map<const EdgeUnknowns> edge(parameters[0]);
    residuals[0] = edge_residual(observation_, camera_, Twist::Zero(), edge, &by) / sigma_px_;
    if (jacobians != nullptr) write_block(jacobians[0], by.edge / sigma_px_);
    return std::isfinite(residuals[0]);
  }

 private:
  EdgeObservation observation_;
  PinholeCamera camera_;
  double sigma_px_;
};

class EdgeOptimizer {
 public:
  EdgeOptimizer(const ViewWindow& window, const PinholeCamera& camera)
      : window_(window),
        view_from_world_(window.world_from_reference().inverse()),
        undistorted_(camera.undistorted()),
        undistortion_(camera) {}

  /// By the window's events that were assigned to the edge and to no other: those of a neighbour, which
  /// lie near it, too, would pull it over. False where too few events say anything, or no optimum is
  /// found.
  bool optimize(std::span<const std::uint32_t> events, FittedEdgel& fitted, RefinedDepth& sums) {
    if (events.size() < kMinEvents) return false;
    EdgeUnknowns unknowns(fitted.edge.inverse_depth, 0, 0, 0);
    ceres::Problem problem;
    const auto residuals = add_events(events, fitted, unknowns, problem);
    const EdgeUnknowns sigma = EdgeNoise::prior_sigma(unknowns[0]);
    problem.AddResidualBlock(new LinearPriorCost<4>(root_of_sigma<4>(sigma), unknowns), nullptr,
                             unknowns.data());
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::DENSE_QR;
    solver.max_num_iterations = kIterations;
    solver.num_threads = 1;
    solver.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem, &summary);
    if (!summary.IsSolutionUsable() || !(unknowns[0] > 0)) return false;
    const std::optional<double> sigma_rho = sigma_of(problem, residuals, unknowns);
    if (!sigma_rho) return false;
    sums.cost_before += summary.initial_cost;
    sums.cost_after += summary.final_cost;
    ++sums.edges;
    store(unknowns, *sigma_rho, fitted);
    return true;
  }

 private:
  std::vector<ceres::ResidualBlockId> add_events(std::span<const std::uint32_t> events,
                                                 const FittedEdgel& fitted, EdgeUnknowns& unknowns,
                                                 ceres::Problem& problem) {
    const double sigma_px = EdgeNoise::sigma_px(fitted);
    std::vector<ceres::ResidualBlockId> ids;
    for (const std::uint32_t e : events) {
      const Event& event = window_.events[e];
      const double t_s = seconds_from_ns(event.t_ns);
      EdgeObservation observation;
      observation.view_from_camera = view_from_world_ * window_.world_from_camera(t_s);
      observation.ray = undistorted_.ray(undistortion_(event.x, event.y).cast<double>());
      observation.lag = event.polarity;
      observation.pixel = fitted.edge.pixel.cast<double>();
      observation.normal = fitted.edge.normal.cast<double>();
      ids.push_back(problem.AddResidualBlock(new EdgeCost(observation, undistorted_, sigma_px),
                                             new ceres::CauchyLoss(EdgeNoise::kCauchyScale),
                                             unknowns.data()));
    }
    return ids;
  }

  /// Standard deviation of the inverse depth [1/m].
  [[nodiscard]] std::optional<double> sigma_of(ceres::Problem& problem,
                                               const std::vector<ceres::ResidualBlockId>& residuals,
                                               EdgeUnknowns& unknowns) const {
    const Eigen::MatrixXd information = marginal_information(problem, {unknowns.data()}, {});
    if (information.size() == 0) return std::nullopt;
    const Eigen::LLT<Eigen::Matrix4d> factor(information);
    if (factor.info() != Eigen::Success) return std::nullopt;
    double squares = 0;
    for (const ceres::ResidualBlockId id : residuals) {
      double value = 0;
      problem.EvaluateResidualBlock(id, false, nullptr, &value, nullptr);
      squares += clipped_square(value);
    }
    const double spread = squares / static_cast<double>(residuals.size());
    const Eigen::Vector4d of_depth = factor.solve(Eigen::Vector4d::UnitX());
    return std::sqrt(of_depth[0] * spread / kInformationRatio);
  }

  static void store(const EdgeUnknowns& x, double sigma, FittedEdgel& fitted) {
    Edgel& edge = fitted.edge;
    const Eigen::Vector2f tangent = edge.tangent();
    edge.pixel += static_cast<float>(x[1]) * edge.normal;
    edge.normal = (edge.normal - static_cast<float>(x[2]) * tangent).normalized();
    edge.inverse_depth = static_cast<float>(x[0]);
    fitted.sigma = static_cast<float>(sigma);
  }

  const ViewWindow& window_;
  Rigid3 view_from_world_;
  PinholeCamera undistorted_;
  UndistortionTable undistortion_;
};

/// A run's points by their pixel.
class PointsByPixel {
 public:
  PointsByPixel(std::span<const EdgePoint> points, const PinholeCamera& camera)
      : points_(points), width_(camera.width), height_(camera.height) {
    cells_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    for (std::size_t i = 0; i < points.size(); ++i) {
      const int x = static_cast<int>(std::lround(points[i].x_px));
      const int y = static_cast<int>(std::lround(points[i].y_px));
      if (x >= 0 && y >= 0 && x < width_ && y < height_)
        cells_[static_cast<std::size_t>(y * width_ + x)].push_back(i);
    }
  }

  /// The nearest point within reach and of the same depth; nullptr where there is none.
  [[nodiscard]] const EdgePoint* near(const Edgel& edge) const {
    const int reach = static_cast<int>(std::ceil(kNear_px)) + 1;
    const int x0 = static_cast<int>(edge.pixel.x()), y0 = static_cast<int>(edge.pixel.y());
    const EdgePoint* nearest = nullptr;
    auto least = static_cast<float>(kNear_px);
    for (int y = std::max(0, y0 - reach); y <= std::min(height_ - 1, y0 + reach); ++y)
      for (int x = std::max(0, x0 - reach); x <= std::min(width_ - 1, x0 + reach); ++x)
        for (const std::size_t i : cells_[static_cast<std::size_t>(y * width_ + x)]) {
          const EdgePoint& point = points_[i];
          const float away = (edge.pixel - Eigen::Vector2f(point.x_px, point.y_px)).norm();
          const float other = std::abs(point.inverse_depth / edge.inverse_depth - 1);
          if (away > least || other > static_cast<float>(kDepthTolerance)) continue;
          least = away;
          nearest = &point;
        }
    return nearest;
  }

 private:
  std::span<const EdgePoint> points_;
  int width_, height_;
  std::vector<std::vector<std::size_t>> cells_;
};

}  // namespace

RefinedDepth refine_depth_of(const ViewWindow& window, std::span<const EdgePoint> start,
                             const PinholeCamera& camera, const RayDepth& depth) {
  const PointsByPixel points(start, camera);
  return depth.with_open_gates<RefinedDepth>(
      [&](const RayDepth& opened) {
        RefinedDepth refined;
        WindowEdgels edges = opened.find_delayed_edgels(window);
        ViewWindow delayed = window;
        delayed.event_delay_s = edges.delay.delay_s;
        EdgeOptimizer optimizer(delayed, camera);
        std::vector<FittedEdgel> kept;
        for (FittedEdgel& fitted : edges.edges) {
          const EdgePoint* point = points.near(fitted.edge);
          if (point == nullptr) continue;
          fitted.edge.inverse_depth = point->inverse_depth;
          if (optimizer.optimize(std::span<const std::uint32_t>(edges.events.event)
                                     .subspan(fitted.first, fitted.last - fitted.first),
                                 fitted, refined))
            kept.push_back(fitted);
        }
        edges.edges = std::move(kept);
        refined.result = opened.fuse(edges);
        return refined;
      },
      [](const RefinedDepth& refined) { return refined.result.points.size(); });
}

}  // namespace saccade
