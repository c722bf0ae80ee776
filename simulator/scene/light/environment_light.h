#pragma once

#include <filesystem>
#include <optional>

#include <Eigen/Core>

#include "core/config/fields.h"
#include "core/image.h"
#include "simulator/scene/light/vector_range.h"

namespace saccade {

/// The light of the surroundings (section `scene.environment_light`).
struct EnvironmentLightOptions {
  double scale = 1;  ///< multiplies the radiance of the surroundings
  std::optional<std::filesystem::path> picture = std::nullopt;  ///< of them; none: the background
};

/// What surroundings infinitely far away throw onto a Lambertian surface, without shadows: their
/// irradiance over pi, a quadratic form in the unit normal n. It is the spherical harmonics' sum up
/// to second order (Ramamoorthi and Hanrahan, SIGGRAPH 2001), with max(0, x) in Legendre's
/// polynomials as 1/4 + x/2 + 5/32 (3 x^2 - 1) + ...:
///   e(n) = c + b . n + n^T Q n,   c = 3/(32 pi) int L dw,   b = 1/(2 pi) int L w dw,
///   Q = 15/(32 pi) int L w w^T dw
/// Exact for light that varies with direction in order 2 or less, as uniform light L, of which
/// e = L. A small source that gives a surface facing it e = 1 alone is off by 0.063 there and by
/// 0.094 at most, at right angles to it; so no more than that part of all light is off for any map.
class EnvironmentLight {
 public:
  /// `map`: equirectangular as Background has it, at least 1 x 1, each texel of one radiance.
  EnvironmentLight(const ImageF& map, double yaw_deg, double scale);
  /// The same from all sides.
  explicit EnvironmentLight(double radiance) : constant_(radiance) {}

  /// Radiance of a white surface with this unit normal, not negative.
  [[nodiscard]] double radiance(const Eigen::Vector3d& normal) const {
    const double value =
        constant_ + linear_.dot(normal) + normal.dot(Eigen::Vector3d(quadratic_ * normal));
    return value > 0 ? value : 0;
  }

  /// Of it along normals within these bounds.
  [[nodiscard]] LightRange range(const VectorRange& normal) const;

 private:
  double constant_ = 0;
  Eigen::Vector3d linear_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d quadratic_ = Eigen::Matrix3d::Zero();
};

void describe(config::Fields& fields, EnvironmentLightOptions& options);

}  // namespace saccade
