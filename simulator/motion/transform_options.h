#pragma once

#include <Eigen/Core>

namespace saccade {

namespace config {
class Fields;
}

/// Scale, then rotation R = Rz Ry Rx, then translation.
struct TransformOptions {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d rotation_deg = Eigen::Vector3d::Zero();
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();  ///< > 0; one number or three
};

void describe(config::Fields& fields, TransformOptions& options);

/// R = Rz Ry Rx; `angles_deg` about x, y and z.
[[nodiscard]] Eigen::Matrix3d rotation_of(const Eigen::Vector3d& angles_deg);

}  // namespace saccade
