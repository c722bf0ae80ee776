#pragma once

#include <memory>

#include <ceres/cost_function.h>

#include <Eigen/Core>

#include "core/spline/knots.h"
#include "core/trajectory.h"
#include "estimator/edges/least_squares/path_information.h"

namespace saccade {

/// What is known of a camera's path from edges that are not adjusted any more, and from poses that
/// have left what is adjusted: the marginal of fixed-lag smoothing (Leutenegger et al., IJRR 2015,
/// section 3.3), a quadratic of the path's correction from where it is believed to be,
///   1/2 x^T H x + g^T x,
/// x the controls of a PathCorrection, 6 for each. Residuals enter as they were linearised when
/// they entered, and are moved with the path, never linearised anew. Knots lie at multiples of their
/// spacing, so that those of overlapping paths coincide. Memory and time do not grow with what was
/// added, but with the length that is kept.
class MarginalPrior {
 public:
  /// `knot_spacing_s` > 0.
  explicit MarginalPrior(double knot_spacing_s) : spacing_s_(knot_spacing_s) {}

  [[nodiscard]] bool empty() const { return gradient_.size() == 0; }

  /// Knots of the grid that cover [start_s, end_s].
  [[nodiscard]] SplineKnots knots(double start_s, double end_s) const;

  /// Adds what is known of the controls over `knots`, whole ones of the grid that begin with the
  /// prior's, about the path where it is believed to be now.
  void add(const SplineKnots& knots, const PathInformation& information);

  /// Adds that the correction is `mean` at an instant.
  void add_pose(const SplineKnots& knots, double t_s, const Twist& mean,
                const Matrix6& information);

  /// The controls are those of `knots` from now on: what is known of earlier ones is marginalised out,
  /// of yet earlier ones nothing is known. `weak`: the information that every control has beside, so
  /// that what nothing is known of may be left out.
  void begin_with(const SplineKnots& knots, const Matrix6& weak);

  /// Now about a path that was corrected by these controls.
  void correct(const SplineKnots& knots, const Eigen::VectorXd& controls);
  /// Now about `after` in place of `before`, which differ little; both cover what is known.
  void move(const Trajectory& before, const Trajectory& after);

  /// As a residual of the first so many controls of `knots`, in blocks of 6; not empty.
  [[nodiscard]] std::unique_ptr<ceres::CostFunction> cost() const;
  [[nodiscard]] std::size_t controls() const {
    return static_cast<std::size_t>(gradient_.size()) / 6;
  }

 private:
  /// Room for so many unknowns over `knots`.
  void reach(const SplineKnots& knots, Eigen::Index size);
  [[nodiscard]] std::ptrdiff_t index_of(const SplineKnots& knots) const;

  double spacing_s_;
  std::ptrdiff_t first_ = 0;  ///< of the controls: that of knots that begin at first_ spacing_s_
  Eigen::MatrixXd information_;
  Eigen::VectorXd gradient_;
};

}  // namespace saccade
