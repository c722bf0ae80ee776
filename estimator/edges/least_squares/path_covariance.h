#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "core/io/covariance_file.h"
#include "core/rigid3.h"
#include "estimator/tracking/tracker.h"

namespace saccade {

/// Covariances of a cubic spline's unknowns, six of each control: block i of the controls i .. i + 3,
/// on which a pose depends. Memory grows with the length of the path alone.
using SplineCovariances = std::vector<Eigen::Matrix<double, 24, 24>>;

/// The blocks of a covariance of all controls.
[[nodiscard]] SplineCovariances spline_covariances(const Eigen::MatrixXd& covariance);

/// Covariance of a pose of a cubic spline, propagated to first order:
///   J C J^T,
/// C that of the four controls from `first_control` on, and J the derivative of the pose's twist
/// (v, w), in the camera's axes, by them. 0 where `covariances` is empty, which says that they are
/// not determined.
[[nodiscard]] Matrix6 covariance_at(const SplineCovariances& covariances, std::size_t first_control,
                                    const Eigen::Matrix<double, 6, 24>& by_controls);

/// Gives poses the sigmas of their covariances at their times. Returns these covariances, one for
/// each pose of the trajectory: of increasing times, without those of gaps.
[[nodiscard]] std::vector<StampedCovariance> set_sigmas(
    std::span<TrackedPose> poses, const std::function<Matrix6(double t_s)>& covariance);

}  // namespace saccade
