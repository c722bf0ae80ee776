#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/large_vector.h"
#include "simulator/scene/background.h"
#include "simulator/scene/intersection/triangle_bvh.h"
#include "simulator/scene/intersection/visibility.h"
#include "simulator/scene/light/illumination.h"
#include "simulator/scene/light/patch_lighting.h"
#include "simulator/scene/mesh/mesh.h"
#include "simulator/scene/normal_frame.h"
#include "simulator/scene/scene.h"

namespace saccade {

/// The body of triangles that are static; others are indices into the moving objects.
constexpr std::uint32_t kStaticBody = std::numeric_limits<std::uint32_t>::max();

/// Beyond this many lengths of its direction a ray has left the triangle by more than a hair.
inline constexpr double kFarthest = 1e12;

/// What shading one triangle reads, in its body's frame: two cache lines. Where its corners move,
/// x and y are forms of the point's weights of the second and the third corner, as are those of its
/// Cutout, and the plane is not known but for one instant (Scene::State::instant()).
struct alignas(64) TriangleSurface {
  AffineForm plane;        ///< unit normal; zero on the plane
  AffineForm x;            ///< texel column; without a texture the albedo
  AffineForm y;            ///< texel row
  const Texture* texture;  ///< nullptr: none
  double factor;           ///< multiplies the texture
  std::uint32_t object;
  std::uint32_t body = kStaticBody;
  double self_light = 0;  ///< of its material

  /// What stands for the irradiance where that is `light`.
  [[nodiscard]] double with_self_light(double light) const {
    return std::isinf(self_light) ? 1 : light + self_light;
  }
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

/// A triangle whose corners move, as it is at one instant.
struct TriangleInstant {
  TriangleSurface surface;
  TriangleInterior interior;
};

/// The triangles of a moving object by number, as indices into the vertices of its animation; none
/// where it is rigid.
struct AnimatedTriangles {
  std::vector<CornerIndices> opaque, cut_out;
  TriangleId first_opaque = 0, first_cut_out = 0;

  [[nodiscard]] const CornerIndices& corners(TriangleId triangle) const {
    return triangle >= first_opaque && triangle - first_opaque < opaque.size()
               ? opaque[triangle - first_opaque]
               : cut_out[triangle - first_cut_out];
  }
};

/// Corners' unit normals in the body's frame.
using ShadingNormals = std::array<Eigen::Vector3f, 3>;

/// Of triangles without a normal map.
constexpr std::uint32_t kNoFrame = std::numeric_limits<std::uint32_t>::max();

/// A triangle that mirrors lights.
struct GlossyTriangle {
  TriangleId number;
  Gloss gloss;
};

/// A part of a triangle.
struct Patch {
  TriangleId triangle;
  double side;                           ///< of the plane it is seen from: 1 above zero, -1 below
  std::vector<Eigen::Vector3d> corners;  ///< it is within their hull
};

/// What may hide a light from a triangle.
struct OccluderCandidates {
  LightSet bit;
  std::vector<TriangleId> triangles;
};

/// How the lights light one side of a triangle: all there is to know where that is little, else the
/// candidates for parts of it, or where they are too many, nothing.
struct TriangleLighting {
  std::once_flag found;
  std::unique_ptr<const PatchLighting> lighting;
  LightSet unoccluded = 0;
  std::unique_ptr<std::vector<OccluderCandidates>> candidates;
};

/// The triangles of a scene by number: opaque ones first, then those with cutouts; in both parts
/// what is static first, then object by object what moves.
struct Scene::State {
  LargeVector<TriangleSurface> surfaces;
  LargeVector<TriangleInterior> interiors;
  LargeVector<ShadingNormals> normals;         ///< empty without lighting
  std::vector<NormalFrame> normal_frames;      ///< of triangles with a normal map
  std::vector<std::uint32_t> normal_frame_of;  ///< by triangle, or kNoFrame; empty: of none
  std::vector<std::shared_ptr<const NormalTexture>> normal_maps;  ///< keeps them alive
  std::vector<Gloss> glosses;                                     ///< by triangle; empty: all matt
  std::vector<Cutout> cutouts;                                    ///< of the last triangles
  std::vector<std::uint16_t> triangle_instances;                  ///< from 1 on
  std::vector<SceneInstance> instances;                           ///< instance k is item k - 1
  std::vector<std::shared_ptr<const Texture>> textures;           ///< keeps them alive
  Background background{0.5};
  std::optional<Illumination> illumination;  ///< none: the albedo is the radiance
  std::optional<Visibility> visibility;
  std::vector<AnimatedTriangles> animated;  ///< of the moving objects
  double size_m = 0;                        ///< of everything that is static
  /// Of what is static, then of the moving objects, each in its own frame.
  std::vector<TriangleBvh> bvhs;
  std::once_flag triangle_lightings_built;
  std::unique_ptr<TriangleLighting[]> triangle_lightings;  ///< two per triangle

  /// use(ray, surface, interior) in the frame of a triangle's body, at the time of the ray.
  template <class Use>
  auto with_triangle(TriangleId triangle, const Ray& ray, const Use& use) const {
    const TriangleSurface& surface = surfaces[triangle];
    if (surface.body == kStaticBody) return use(ray, surface, interiors[triangle]);
    const MovingObject& object = visibility->objects()[surface.body];
    const Ray local = in_frame(object.frame(ray.time_s), ray);
    if (object.animation() == nullptr) return use(local, surface, interiors[triangle]);
    const TriangleInstant now = instant(triangle, ray.time_s);
    return use(local, now.surface, now.interior);
  }

  /// How the corners of a triangle move in its body's frame; nullptr: not at all.
  [[nodiscard]] const VertexAnimation* animation_of(TriangleId triangle) const {
    const std::uint32_t body = surfaces[triangle].body;
    return body == kStaticBody ? nullptr : visibility->objects()[body].animation();
  }
  /// Of a triangle whose corners move.
  [[nodiscard]] TriangleInstant instant(TriangleId triangle, double t_s) const;
  [[nodiscard]] ShadingNormals normals_at(TriangleId triangle, double t_s,
                                          const AffineForm& plane) const;
  /// Weights of the corners of the point that a ray meets; of any triangle.
  [[nodiscard]] Eigen::Vector3d corner_weights(const Ray& ray, TriangleId triangle) const;

  /// Of a ray in the frame of the triangle's body:
  [[nodiscard]] bool is_opaque(const Ray& ray, TriangleId triangle) const;
  /// Without the light; distance 0 where the ray misses the plane.
  [[nodiscard]] SurfaceSample sample_surface(const Ray& ray, const TriangleSurface& surface) const;
  [[nodiscard]] CutoutSample sample_cutout(const Ray& ray, TriangleId triangle,
                                           const TriangleSurface& surface,
                                           const TriangleInterior& interior) const;
  /// As Scene::min_barycentric().
  [[nodiscard]] double min_barycentric(const Ray& ray, const TriangleSurface& surface,
                                       const TriangleInterior& interior) const;
  /// As Scene::edge_functions(), in the body's frame.
  [[nodiscard]] EdgeFunctions edge_functions(TriangleId triangle, const Eigen::Vector3d& position,
                                             const Eigen::Matrix3d& body_from_camera) const;
  /// nullptr: it has no normal map.
  [[nodiscard]] const NormalFrame* normal_frame(TriangleId triangle) const {
    if (normal_frame_of.empty() || normal_frame_of[triangle] == kNoFrame) return nullptr;
    return &normal_frames[normal_frame_of[triangle]];
  }
  /// In the body's frame. `corners`: the normals there.
  [[nodiscard]] LitPoint local_point(const Ray& ray, const SurfaceSample& seen, TriangleId triangle,
                                     const AffineForm& plane, const TriangleInterior& interior,
                                     const ShadingNormals& corners) const;
  /// The axes of its normal map where a ray meets a triangle that has one, on the side that is seen;
  /// in the world, as is `ray`.
  [[nodiscard]] Eigen::Matrix3d normal_map_axes(const Ray& ray, double distance,
                                                TriangleId triangle) const;

  /// nullopt: it casts none, edge-on to the light. `patch`: a point near where it may fall.
  [[nodiscard]] std::optional<Occluder> make_occluder(TriangleId triangle,
                                                      const LightOptions& light,
                                                      const Eigen::Vector3d& patch) const;
  /// What may stand between a light and a convex patch, given by points around it, from
  /// `shadow_offset` above it on, above zero of `front`; false where that is not known.
  [[nodiscard]] bool collect_occluders(const LightOptions& light,
                                       std::span<const Eigen::Vector3d> patch,
                                       const Eigen::Vector3d& shadow_offset,
                                       const AffineForm& front, std::size_t most,
                                       std::vector<TriangleId>& found);
  /// Of the triangles `found` those that hide a part of the patch; false where one hides it all.
  [[nodiscard]] bool select_occluders(const LightOptions& light, const Patch& patch,
                                      const Eigen::Vector3d& shadow_offset,
                                      std::span<const TriangleId> found,
                                      std::vector<Occluder>& occluders) const;
  /// Adds a light that the patch faces to its light.
  void add_light(LightSet bit, const Patch& patch, std::span<const TriangleId> found,
                 PatchLighting& lighting) const;
  /// The light on a patch; false where it is not known.
  [[nodiscard]] bool find_lighting(const Patch& patch, std::size_t most, PatchLighting& lighting);
  /// The same from the candidates of its triangle.
  void find_lighting(const Patch& patch, const TriangleLighting& whole,
                     PatchLighting& lighting) const;
  /// Of a whole triangle, found once.
  [[nodiscard]] const TriangleLighting& triangle_lighting(TriangleId triangle, double side);

  /// nullptr: it is matt.
  [[nodiscard]] const Gloss* gloss_of(TriangleId triangle) const {
    if (glosses.empty() || triangle == kNothing || glosses[triangle].is_matt()) return nullptr;
    return &glosses[triangle];
  }
  /// Sets what the point of a triangle at the end of a ray reflects of `seen.lights`.
  void set_light(const Ray& ray, const LitPoint& point, TriangleId triangle,
                 SurfaceSample& seen) const;
  /// As Scene::illuminate(). `within_cones`: of spots only those in whose cone a point is.
  void illuminate(std::span<const Ray> rays, std::span<const TriangleId> triangles,
                  std::span<SurfaceSample> samples, bool within_cones) const;

  /// In the world, as is `ray`.
  [[nodiscard]] LitPoint surface_point(const Ray& ray, const SurfaceSample& seen,
                                       TriangleId triangle) const;
};

/// Distance along the ray to a plane [length of the direction]; not finite where they are parallel.
[[nodiscard]] inline double distance_to(const AffineForm& plane, const Ray& ray) {
  return -plane.at(ray.origin) / plane.gradient.dot(ray.direction);
}

}  // namespace saccade
