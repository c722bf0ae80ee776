#pragma once

#include <cstddef>
#include <vector>

#include <ceres/ceres.h>

#include "core/trajectory.h"
#include "estimator/imu/inertial_alignment.h"
#include "estimator/refinement/inertial_cost.h"
#include "estimator/refinement/path_correction.h"

namespace saccade {

/// An inertial sensor's part in a joint refinement.
struct InertialRowsOptions {
  bool use = false;
  double interval_s = 0.1;        ///< readings are summed up over so long
  double bias_spacing_s = 10;     ///< biases are even for so long
  double gyro_bias_step = 1e-3;   ///< of one from the bias before [rad/s]
  double accel_bias_step = 1e-2;  ///< the same [m/s^2]
  double accel_bias_sigma = 0.2;  ///< of the first [m/s^2]
  double offset_sigma_s = 0.01;   ///< of the readings' clock from what the path's turns say
  /// What the path's spline cannot follow, in turn [rad] and place, over the typical depth.
  double slack_rad = 3e-4, slack = 1e-4;
};

/// Where they start from.
struct InertialRowsStart {
  const MountedImu& imu;
  InertialAlignment aligned;  ///< of the path; with gravity
  bool is_metric = true;      ///< the path is in metres; else its scale is one more unknown
  double typical_depth_m = 1;
};

/// Gravity, biases, scale, time offset and the sensor's velocities, and the readings that tie them
/// to a path's correction (InertialCost). Outlives the problem that it adds to.
class InertialRows {
 public:
  /// `weight`: of a residual, over 1 / its deviation.
  InertialRows(const Trajectory& path, const SplineKnots& knots, const InertialRowsStart& start,
               const InertialRowsOptions& options, double weight);

  /// Its unknowns join the last group of the ordering.
  void add_to(ceres::Problem& problem, PathCorrection& correction,
              ceres::ParameterBlockOrdering& ordering);

  [[nodiscard]] std::vector<double*> unknowns();
  /// What was found, with the first bias; deviations are the start's.
  [[nodiscard]] InertialAlignment found() const;

 private:
  struct Link {
    std::size_t node;
    Preintegration sum;
  };

  [[nodiscard]] InertialNode node_at(double t_s) const;
  [[nodiscard]] InertialCost::Matrix9 root_of(const Preintegration& sum) const;
  [[nodiscard]] double* velocity(std::size_t node) { return &unknowns_[3 * node]; }
  [[nodiscard]] double* bias(std::size_t i) { return &unknowns_[3 * nodes_.size() + 6 * i]; }
  [[nodiscard]] double* shared() { return &unknowns_[unknowns_.size() - InertialFrame::kSize]; }
  [[nodiscard]] std::size_t bias_of(std::size_t node) const;
  void hold(ceres::Problem& problem);

  const Trajectory& path_;
  SplineKnots knots_;
  InertialRowsStart start_;
  const InertialRowsOptions& options_;
  double weight_;
  InertialFrame frame_;
  std::vector<InertialNode> nodes_;
  std::vector<double> times_s_;
  std::vector<Link> links_;
  std::size_t biases_ = 1;
  std::vector<double> unknowns_;  ///< velocities, biases, the shared frame
};

}  // namespace saccade
