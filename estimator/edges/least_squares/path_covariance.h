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

/// Covariance of a pose of a cubic spline, propagated to first order:
///   J C J^T,
/// C the part of `covariance` that belongs to the four controls from `first_control` on, six
/// unknowns each, and J the derivative of the pose's twist (v, w), in the camera's axes, by them. 0
/// where `covariance` is empty, which says that it is not determined.
[[nodiscard]] Matrix6 covariance_at(const Eigen::MatrixXd& covariance, std::size_t first_control,
                                    const Eigen::Matrix<double, 6, 24>& by_controls);

/// Gives poses the sigmas of their covariances at their times; returns these covariances.
[[nodiscard]] std::vector<StampedCovariance> set_sigmas(
    std::span<TrackedPose> poses, const std::function<Matrix6(double t_s)>& covariance);

}  // namespace saccade
