#pragma once

#include <cstddef>
#include <vector>

#include "core/trajectory.h"
#include "estimator/edges/least_squares/edge_bundle.h"
#include "estimator/edges/path/inertial_cost.h"
#include "estimator/edges/path/path_correction.h"
#include "estimator/imu/inertial_alignment.h"

namespace saccade {

/// Where they start from.
struct InertialStart {
  const MountedImu& imu;
  InertialAlignment aligned;  ///< of the path; with gravity
  bool is_metric = true;      ///< the path is in metres; else its scale is one more unknown
  double typical_depth_m = 1;
};

/// Gravity, biases, scale, time offset and the sensor's velocities, and the preintegrated samples
/// that constrain them together with a path's correction (InertialCost). Outlives the bundle that it adds to.
class InertialFactors {
 public:
  /// `interval_s`: over which samples are preintegrated; `weight`: of a residual, over 1 / its sigma.
  InertialFactors(const Trajectory& path, const SplineKnots& knots, const InertialStart& start,
                  double interval_s, double weight);

  /// `correction` is that of the bundle's path.
  void add_to(PathBundle& bundle, PathCorrection& correction);

  /// What was found, with the first bias; sigmas are the start's.
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
  [[nodiscard]] double* frame() { return &unknowns_[unknowns_.size() - InertialFrame::kSize]; }
  [[nodiscard]] std::size_t bias_of(std::size_t node) const;
  void add_priors(PathBundle& bundle);

  const Trajectory& path_;
  SplineKnots knots_;
  InertialStart start_;
  double interval_s_;
  double weight_;
  InertialFrame frame_;
  std::vector<InertialNode> nodes_;
  std::vector<double> times_s_;
  std::vector<Link> links_;
  std::size_t biases_ = 1;
  std::vector<double> unknowns_;  ///< velocities, biases, the inertial frame
};

}  // namespace saccade
