#include "estimator/refinement/pose_refinement.h"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "estimator/refinement/held_cost.h"
#include "estimator/refinement/level_cost.h"
#include "estimator/refinement/marginal_information.h"
#include "estimator/refinement/robust_spread.h"
#include "estimator/refinement/schur_solver.h"

namespace saccade {
namespace {

/// An observation with what it saw of the map.
struct Seen {
  const LevelObservation* observation;
  MapSurface::Hit hit;
  double level;  ///< that the map shows
  double sigma;
};

/// One round: the surfaces as the path of before sees them, and the problem of the next path.
class Round {
 public:
  Round(const MapSurface& surface, const LevelChains& levels, const SplineControls& path,
        const PoseRefinementOptions& options)
      : surface_(surface),
        levels_(levels),
        path_(path),
        options_(options),
        corrections_(path.poses.size()),
        offsets_(levels.chains),
        length_(levels.chains) {
    for (auto& correction : corrections_) correction.fill(0);
    find_surfaces();
    start_offsets();
    add_events();
    hold_controls();
  }

  void solve(CostLog& costs) {
    const double start_s = costs.now_s();
    const auto summary = solve_by_schur(problem_, ordering_, options_.iterations, 1e-6);
    costs.add_round(summary.iterations, start_s);
  }

  [[nodiscard]] SplineControls path() const {
    SplineControls path = path_;
    for (std::size_t k = 0; k < path.poses.size(); ++k)
      path.poses[k] = corrected(path_.poses[k], corrections_[k].data());
    return path;
  }

  /// Evidence, and what the path is known to.
  void judge(RefinedPath& result) {
    std::vector<double> deviations;
    for (const Residual& residual : residuals_) {
      double value = 0;
      problem_.EvaluateResidualBlock(residual.id, false, nullptr, &value, nullptr);
      deviations.push_back(std::abs(value) * residual.sigma);
      if (std::abs(value) < kInlier) ++result.inliers;
      squares_ += bounded_square(value);
    }
    result.observations = residuals_.size();
    if (residuals_.empty()) return;
    result.residual = gaussian_deviation(deviations);
    result.covariance = covariance();
  }

 private:
  struct Residual {
    ceres::ResidualBlockId id;
    double sigma;
  };

  void find_surfaces() {
    constexpr double kStep_s = 1e-3;
    const Spline spline = path_.spline();
    MapView view(surface_.map(), 1);
    double looked_s = -1;
    bool is_drawn = false;
    for (const LevelObservation& o : levels_.observations) {
      const Rigid3 pose = spline.pose(o.t_s);
      if (!is_drawn || o.t_s - looked_s > kStep_s) {
        if (!is_drawn || view.moved_px(pose) > options_.redraw_px) view.draw(pose);
        is_drawn = true;
        looked_s = o.t_s;
      }
      const Eigen::Vector2i node = view.node_at(o.pixel);
      if (!view.contains(node.x(), node.y())) continue;
      const auto hit = surface_.meet(view(node.x(), node.y()), pose, o.ray);
      if (hit) see(o, *hit);
    }
  }

  void see(const LevelObservation& o, const MapSurface::Hit& hit) {
    const SampleWithGradient<double> map = surface_.read(hit.view, hit.pixel);
    if (!std::isfinite(map.value)) return;
    const double misplaced = options_.place_px * std::hypot(map.dx, map.dy);
    seen_.push_back({&o, hit, map.value, std::hypot(options_.noise, misplaced)});
    ++length_[o.chain];
  }

  /// The middle of what the map shows above the levels of a chain.
  void start_offsets() {
    std::vector<std::vector<double>> excess(offsets_.size());
    for (const Seen& seen : seen_)
      excess[seen.observation->chain].push_back(seen.level - seen.observation->level);
    for (std::size_t i = 0; i < offsets_.size(); ++i)
      if (!excess[i].empty()) offsets_[i] = median_of(excess[i]);
  }

  void add_events() {
    for (const Seen& seen : seen_) {
      const LevelObservation& o = *seen.observation;
      if (length_[o.chain] < 2) continue;
      LevelCost::Observation observation;
      observation.time = path_.knots.at(o.t_s);
      std::array<double*, 4> blocks{};
      for (std::size_t k = 0; k < 4; ++k) {
        observation.controls[k] = path_.poses[observation.time.first + k];
        blocks[k] = corrections_[observation.time.first + k].data();
      }
      observation.ray = o.ray;
      observation.level = o.level;
      observation.sigma = seen.sigma;
      observation.hit = seen.hit;
      double* offset = &offsets_[o.chain];
      const auto id = problem_.AddResidualBlock(new LevelCost(observation, surface_),
                                                new ceres::CauchyLoss(options_.outlier), blocks[0],
                                                blocks[1], blocks[2], blocks[3], offset);
      residuals_.push_back({id, seen.sigma});
      if (ordering_->IsMember(offset)) continue;
      ordering_->AddElementToGroup(offset, 0);
      used_offsets_.push_back(offset);
    }
  }

  /// Loosely, where no event sees the map.
  void hold_controls() {
    const double turn = options_.hold_px / surface_.map().camera().fx;
    Twist sigma;
    sigma << Eigen::Vector3d::Constant(turn * typical_depth_m()), Eigen::Vector3d::Constant(turn);
    for (auto& correction : corrections_) {
      problem_.AddResidualBlock(new HeldCost<kControlSize>(Twist::Zero(), sigma), nullptr,
                                correction.data());
      ordering_->AddElementToGroup(correction.data(), 1);
    }
  }

  [[nodiscard]] double typical_depth_m() const {
    double inverse = 0;
    for (const Seen& seen : seen_)
      inverse += seen.hit.plane.dot(surface_.map().camera().ray(seen.hit.pixel));
    return seen_.empty() ? 1 : static_cast<double>(seen_.size()) / inverse;
  }

  [[nodiscard]] Eigen::MatrixXd covariance() {
    std::vector<double*> controls;
    for (auto& correction : corrections_) controls.push_back(correction.data());
    const Eigen::MatrixXd information = marginal_information(problem_, controls, used_offsets_);
    const Eigen::LLT<Eigen::MatrixXd> factor(information);
    if (factor.info() != Eigen::Success) return {};
    const double spread = squares_ / static_cast<double>(residuals_.size());
    return spread / options_.information *
           factor.solve(Eigen::MatrixXd::Identity(information.rows(), information.cols()));
  }

  const MapSurface& surface_;
  const LevelChains& levels_;
  const SplineControls& path_;
  const PoseRefinementOptions& options_;
  std::vector<std::array<double, kControlSize>> corrections_;
  std::vector<double> offsets_;
  std::vector<int> length_;  ///< of a chain as far as it is seen
  std::vector<Seen> seen_;
  std::vector<Residual> residuals_;
  std::vector<double*> used_offsets_;
  double squares_ = 0;
  ceres::Problem problem_;
  std::shared_ptr<ceres::ParameterBlockOrdering> ordering_ =
      std::make_shared<ceres::ParameterBlockOrdering>();
};

}  // namespace

Matrix6 RefinedPath::covariance_at(double t_s) const {
  if (covariance.size() == 0) return Matrix6::Zero();
  const SplineKnots::Place place = map_from_camera.knots.at(t_s);
  std::array<Rigid3, 4> controls;
  for (std::size_t k = 0; k < 4; ++k) controls[k] = map_from_camera.poses[place.first + k];
  const PoseOverControls pose = pose_over(place, controls);
  const Eigen::Matrix3d camera_from_map = pose.world_from_body.rotation_matrix().transpose();
  Eigen::Matrix<double, 6, 24> by_controls = Eigen::Matrix<double, 6, 24>::Zero();
  for (Eigen::Index k = 0; k < 4; ++k) {
    by_controls.block<3, 3>(0, 6 * k) = place.weight[k] * camera_from_map;
    by_controls.block<3, 3>(3, 6 * k + 3) = pose.rotation_jacobian.middleCols<3>(3 * k);
  }
  const auto first = static_cast<Eigen::Index>(kControlSize * place.first);
  return by_controls * covariance.block<24, 24>(first, first) * by_controls.transpose();
}

RefinedPath refine_path(const MapSurface& surface, const PinholeCamera& camera,
                        const EventContrast& contrast, std::span<const Event> events,
                        std::span<const StampedPose> start, const PoseRefinementOptions& options) {
  RefinedPath result;
  result.map_from_camera = SplineControls::smooth(start, options.knot_spacing_s);
  const LevelChains levels = observe_levels(events, camera, contrast, options.chains);
  for (int i = 0; i < options.rounds; ++i) {
    Round round(surface, levels, result.map_from_camera, options);
    round.solve(result.costs);
    if (i + 1 == options.rounds) round.judge(result);
    result.map_from_camera = round.path();
  }
  return result;
}

}  // namespace saccade
