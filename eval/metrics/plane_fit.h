#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace saccade {

/// n . x = d with |n| = 1.
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double offset = 0;  ///< [m]
};

struct FittedPlane {
  Plane plane;
  std::vector<std::size_t> points;  ///< indices, ascending
};

/// The planes that most points lie on, one after the other: random triples (a fixed seed) of the
/// points that are left, the plane with most of them within `tolerance_m`, least squares over these
/// until they stay the same. At most `count` planes, each of at least 20 points.
[[nodiscard]] std::vector<FittedPlane> fit_planes(std::span<const Eigen::Vector3d> points,
                                                  double tolerance_m, std::size_t count);

/// Between the planes, 0..90.
[[nodiscard]] double angle_between_deg(const Plane& a, const Plane& b);

}  // namespace saccade
