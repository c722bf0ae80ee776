#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "simulator/scene/background.h"
#include "simulator/scene/illumination.h"
#include "simulator/scene/mesh.h"
#include "simulator/scene/ray_caster.h"
#include "simulator/scene/scene.h"

namespace saccade {

/// a . p + b of a point p of the world.
struct AffineForm {
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  double offset = 0;

  [[nodiscard]] double at(const Eigen::Vector3d& point) const {
    return gradient.dot(point) + offset;
  }
};

/// What shading one triangle reads: two cache lines.
struct alignas(64) TriangleSurface {
  AffineForm plane;        ///< unit normal; zero on the plane
  AffineForm x;            ///< texel column; without a texture the albedo
  AffineForm y;            ///< texel row
  const Texture* texture;  ///< nullptr: none
  double factor;           ///< multiplies the texture
  std::uint32_t object;
};

/// Where a point lies within its triangle: weights of the second and the third corner.
struct alignas(64) TriangleInterior {
  AffineForm second, third;
};

/// Texel coordinates of the alpha map of a triangle that is cut out.
struct Cutout {
  AffineForm x, y;
  const Texture* opacity;
};

/// Corners' unit normals.
using ShadingNormals = std::array<Eigen::Vector3f, 3>;

/// The triangles of a scene by number: opaque ones first, then those with cutouts.
struct Scene::State {
  std::vector<TriangleSurface> surfaces;
  std::vector<TriangleInterior> interiors;
  std::vector<ShadingNormals> normals;                   ///< empty without lighting
  std::vector<Cutout> cutouts;                           ///< of the last triangles
  std::vector<std::shared_ptr<const Texture>> textures;  ///< keeps them alive
  Background background{0.5};
  std::optional<Illumination> illumination;  ///< none: the albedo is the radiance
  std::optional<RayCaster> caster;

  [[nodiscard]] bool is_opaque(const Ray& ray, TriangleId triangle) const;
  [[nodiscard]] SurfacePoint surface_point(const Ray& ray, double distance,
                                           TriangleId triangle) const;
};

/// Distance along the ray to a plane [length of the direction]; not finite where they are parallel.
[[nodiscard]] inline double distance_to(const AffineForm& plane, const Ray& ray) {
  return -plane.at(ray.origin) / plane.gradient.dot(ray.direction);
}

}  // namespace saccade
