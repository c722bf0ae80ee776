#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Geometry>

#include "simulator/scene/intersection/triangle_bvh.h"
#include "simulator/scene/texture/normal_texture.h"

namespace saccade {

/// How a normal map bends the shading normal of a triangle: in the body's frame, its vector v at the
/// texel (x, y) of a point stands for
///   v_x T + v_y B + v_z N,   B = handedness N x T
/// with the interpolated unit normal N and the interpolated tangent T, made perpendicular to N.
struct NormalFrame {
  AffineForm x, y;                          ///< texel coordinates
  std::array<Eigen::Vector3f, 3> tangents;  ///< at the corners; zero: the map does not count there
  float handedness = 1;
  const NormalTexture* map = nullptr;
  std::uint32_t triangle = 0;  ///< its number

  /// Columns T, B and N where the second and the third corner have these weights.
  [[nodiscard]] Eigen::Matrix3d axes(const Eigen::Vector3d& normal, double second,
                                     double third) const {
    Eigen::Vector3d tangent = (1 - second - third) * tangents[0].cast<double>() +
                              second * tangents[1].cast<double>() +
                              third * tangents[2].cast<double>();
    tangent -= tangent.dot(normal) * normal;
    const double length = tangent.norm();
    constexpr double kLeast = 1e-6;
    tangent = length > kLeast ? Eigen::Vector3d(tangent / length) : Eigen::Vector3d::Zero();
    Eigen::Matrix3d columns;
    columns << tangent, static_cast<double>(handedness) * normal.cross(tangent), normal;
    return columns;
  }
};

}  // namespace saccade
