#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "simulator/scene/background.h"
#include "simulator/scene/light/illumination.h"
#include "simulator/scene/mesh/mesh.h"
#include "simulator/scene/visibility/triangle_bvh.h"
#include "simulator/scene/light/patch_lighting.h"
#include "simulator/scene/scene.h"
#include "simulator/scene/visibility/visibility.h"

namespace saccade {

/// The body of triangles that stand still; others are indices into the moving objects.
constexpr std::uint32_t kStill = std::numeric_limits<std::uint32_t>::max();

/// What shading one triangle reads, in its body's frame: two cache lines.
struct alignas(64) TriangleSurface {
  AffineForm plane;        ///< unit normal; zero on the plane
  AffineForm x;            ///< texel column; without a texture the albedo
  AffineForm y;            ///< texel row
  const Texture* texture;  ///< nullptr: none
  double factor;           ///< multiplies the texture
  std::uint32_t object;
  std::uint32_t body = kStill;
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

/// The triangles of a body, in its frame.
struct OccluderSource {
  std::vector<Corners> corners;
  std::vector<TriangleId> ids;
};

/// Corners' unit normals in the body's frame.
using ShadingNormals = std::array<Eigen::Vector3f, 3>;

/// A part of a triangle.
struct Patch {
  TriangleId triangle;
  double side;                           ///< of the plane it is seen from: 1 above zero, -1 below
  std::vector<Eigen::Vector3d> corners;  ///< it is within their hull
};

/// What may hide a lamp from a triangle.
struct LampCandidates {
  LampSet bit;
  std::vector<TriangleId> triangles;
};

/// How the lamps light one side of a triangle: all there is to know where that is little, else the
/// candidates for parts of it, or where they are too many, nothing.
struct WholeLight {
  std::once_flag found;
  std::unique_ptr<const PatchLight> light;
  LampSet proven = 0;
  std::unique_ptr<std::vector<LampCandidates>> candidates;
};

/// The triangles of a scene by number: opaque ones first, then those with cutouts; in both parts
/// what stands still first, then object by object what moves.
struct Scene::State {
  std::vector<TriangleSurface> surfaces;
  std::vector<TriangleInterior> interiors;
  std::vector<ShadingNormals> normals;                   ///< empty without lighting
  std::vector<Cutout> cutouts;                           ///< of the last triangles
  std::vector<std::shared_ptr<const Texture>> textures;  ///< keeps them alive
  Background background{0.5};
  std::optional<Illumination> illumination;  ///< none: the albedo is the radiance
  std::optional<Visibility> visibility;
  double size_m = 0;  ///< of everything that stands still
  /// What the trees are made from when one is first asked.
  std::vector<OccluderSource> occluder_sources;
  std::once_flag trees_built;
  std::vector<OccluderTree> trees;
  std::once_flag whole_lights_built;
  std::unique_ptr<WholeLight[]> whole_lights;  ///< two per triangle

  /// Of what stands still (0), then of the moving objects, each in its own frame.
  [[nodiscard]] const OccluderTree& occluders(std::size_t body);

  /// use(ray) with the ray in the frame of a body.
  template <class Use>
  auto in_frame_of(std::uint32_t body, const Ray& ray, const Use& use) const {
    if (body == kStill) return use(ray);
    return use(in_frame(visibility->objects()[body].frame(ray.time_s), ray));
  }

  /// Of a ray in the frame of the triangle's body:
  [[nodiscard]] bool is_opaque(const Ray& ray, TriangleId triangle) const;
  /// Without the light; distance 0 where the ray misses the plane.
  [[nodiscard]] SurfaceLook look(const Ray& ray, const TriangleSurface& surface) const;
  /// As Scene::inside().
  [[nodiscard]] double inside(const Ray& ray, TriangleId triangle) const;
  /// As Scene::triangle_pass(), in the body's frame.
  [[nodiscard]] TrianglePass triangle_pass(TriangleId triangle, const Eigen::Vector3d& position,
                                           const Eigen::Matrix3d& body_from_camera) const;
  /// In the body's frame.
  [[nodiscard]] LitPoint local_point(const Ray& ray, double distance, TriangleId triangle) const;

  /// nullopt: it casts none, edge-on to the lamp. `patch`: a point near where it may fall.
  [[nodiscard]] std::optional<ShadowCaster> shadow_caster(TriangleId triangle,
                                                          const LightOptions& lamp,
                                                          const Eigen::Vector3d& patch) const;
  /// What may stand between a lamp and a convex patch, given by points around it, above zero of
  /// `front`; false where that is not known.
  [[nodiscard]] bool collect_casters(const LightOptions& lamp,
                                     std::span<const Eigen::Vector3d> patch,
                                     const AffineForm& front, std::size_t most,
                                     std::vector<TriangleId>& found);
  /// Of the triangles `found` those that hide a part of the patch; false where one hides it all.
  [[nodiscard]] bool keep_casters(const LightOptions& lamp, const Patch& patch,
                                  const Eigen::Vector3d& lift, std::span<const TriangleId> found,
                                  std::vector<ShadowCaster>& casters) const;
  /// Adds a lamp that the patch faces to its light.
  void add_lamp(LampSet bit, const Patch& patch, std::span<const TriangleId> found,
                PatchLight& light) const;
  /// The light on a patch; false where it is not known.
  [[nodiscard]] bool find_light(const Patch& patch, std::size_t most, PatchLight& light);
  /// The same from the candidates of its triangle.
  void find_light(const Patch& patch, const WholeLight& whole, PatchLight& light) const;
  /// Of a whole triangle, found once.
  [[nodiscard]] const WholeLight& whole_light(TriangleId triangle, double side);

  /// In the world, as is `ray`.
  [[nodiscard]] LitPoint surface_point(const Ray& ray, double distance, TriangleId triangle) const;
};

/// Distance along the ray to a plane [length of the direction]; not finite where they are parallel.
[[nodiscard]] inline double distance_to(const AffineForm& plane, const Ray& ray) {
  return -plane.at(ray.origin) / plane.gradient.dot(ray.direction);
}

}  // namespace saccade
