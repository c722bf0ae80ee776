#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include <ceres/ceres.h>

#include <Eigen/Core>

#include "core/spline/knots.h"
#include "estimator/edges/least_squares/cost_log.h"
#include "estimator/edges/least_squares/path_covariance.h"
#include "estimator/refinement/poses/log_intensity_sample.h"

namespace saccade {

/// How well a path explains what was observed.
struct PathEvidence {
  std::size_t observations = 0;
  std::size_t inliers = 0;  ///< of them within 2.4 sigma
  double residual = 0;      ///< robust standard deviation [log units]
  /// Of the control poses' corrections (e, w), see log_intensity_sample.h; empty where they are not
  /// determined.
  SplineCovariances covariances;
};

/// One round of a path's refinement: its control poses, and residuals that they are adjusted to.
class PathProblem {
 public:
  explicit PathProblem(const SplineControls& map_from_camera);

  [[nodiscard]] const SplineControls& path() const { return path_; }
  /// The unknowns of `count` control poses from the first one on, as residuals want them.
  [[nodiscard]] std::vector<double*> corrections(std::size_t first, std::size_t count);

  /// A residual of unit sigma, which stands for `sigma` [log units]. Cauchy's loss. Its last
  /// block is another unknown where `eliminated` is one: it is eliminated first, and those of all
  /// residuals lie in one array.
  void add(ceres::CostFunction* cost, double outlier, std::vector<double*> blocks, double sigma,
           double* eliminated = nullptr);

  /// A weak prior about the given path, for where nothing is observed: sigmas of `rotation` [rad] and
  /// of that times `depth_m`.
  void add_weak_prior(double rotation, double depth_m);

  void solve(int iterations, CostLog& costs);
  [[nodiscard]] SplineControls adjusted() const;
  /// `information`: of that of independent residuals.
  [[nodiscard]] PathEvidence judge(double information);

 private:
  struct Residual {
    ceres::ResidualBlockId id;
    double sigma;
  };
  [[nodiscard]] SplineCovariances covariances(double scale);

  SplineControls path_;
  std::vector<std::array<double, kControlSize>> corrections_;
  std::vector<Residual> residuals_;
  std::vector<double*> eliminated_;
  ceres::Problem problem_;
  std::shared_ptr<ceres::ParameterBlockOrdering> ordering_ =
      std::make_shared<ceres::ParameterBlockOrdering>();
};

}  // namespace saccade
