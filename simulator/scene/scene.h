#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "simulator/scene/instance.h"
#include "simulator/scene/light/flicker.h"
#include "simulator/scene/light/vector_range.h"
#include "simulator/scene/texture/texture.h"

namespace saccade {

class NormalTexture;

/// A triangle of the scene, numbered over all meshes; kNothing where a ray intersects none.
using TriangleId = std::uint32_t;
constexpr TriangleId kNothing = std::numeric_limits<TriangleId>::max();

/// A ray in the world at one instant. `direction` need not be a unit vector: distances below are in
/// its length, so with direction = R (x, y, 1) the distance is the z depth.
struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
  double time_s = 0;  ///< at which it sees the moving objects
  double span_s = 0;  ///< around it, over which flickering light is averaged
};

/// How much the direction of a ray differs from those of the next rays to the right and below, in
/// the world and in units of the direction: the ray stands for the parallelogram between them.
struct RayDifferential {
  Eigen::Vector3d right;
  Eigen::Vector3d down;
};

/// What is in view through a rectangle of the image: from the eye through its corners, which are in
/// order around it.
struct Frustum {
  Eigen::Vector3d eye;
  std::array<Eigen::Vector3d, 4> corners;  ///< directions
  double time_s = 0;                       ///< at which it sees the moving objects
};

/// Rays that are traced or lit at once, at most.
constexpr std::size_t kRayPacket = 16;

/// Lights by their index in the list, one bit each.
using LightSet = std::uint64_t;
constexpr std::size_t kMaxLights = 64;

/// What is known of the lights at a point: no ray is traced to these.
struct KnownLights {
  LightSet lit = 0;     ///< nothing hides these
  LightSet hidden = 0;  ///< something hides these
};

/// What the radiance of a visible point is made of: irradiance * factor * texture(x, y, level),
/// without a texture irradiance * x, and what it mirrors.
struct SurfaceSample {
  const Texture* texture = nullptr;
  double x = 0, y = 0;      ///< texel coordinates; without a texture x is the albedo
  double factor = 1;        ///< multiplies the texture
  double irradiance = 1;    ///< under lights; else 1
  double distance = 0;      ///< along Ray::direction [its length]; 0 = background
  double level = 0;         ///< of the texture's pyramid; <= 0: the texture itself
  LightSet lights = 0;      ///< that light the point
  double normal_level = 0;  ///< of the pyramid of the surface's normal map
  double mirrored = 0;      ///< radiance of the lights that a glossy surface shows

  [[nodiscard]] double radiance() const {
    if (texture == nullptr) return irradiance * x + mirrored;
    const double value = level > 0 ? texture->at_texel(x, y, level) : texture->at_texel(x, y);
    return irradiance * (factor * value) + mirrored;
  }
};

/// Bounds of what the light makes of a point over an interval of time.
struct SurfaceLightRange {
  LightRange irradiance;
  LightRange mirrored{0, 0, 0, 0};

  /// Of both ranges' light one or the other.
  void include(const SurfaceLightRange& other) {
    irradiance.include(other.irradiance);
    mirrored.include(other.mirrored);
  }
};

/// The homography from the rays of a camera to the texels on the plane of a static triangle, at one
/// instant (Hartley and Zisserman, 2nd ed., 8.1): the ray d intersects the plane at
///   x = (x . d) / (w . d),   y = (y . d) / (w . d),   distance = depth / (w . d)
struct TexelHomography {
  Eigen::Vector3d x, y, w;
  double depth;
  const Texture* texture;  ///< nullptr: x is the albedo
  double factor;
};

/// The edge functions of a triangle for the rays of a camera (Pineda, SIGGRAPH 1988): the ray d is
/// inside the edges where all edge . d have one sign, and intersects the plane at the distance
///   depth / (w . d)
/// All of it is smooth in time, also while the plane goes through the camera.
struct EdgeFunctions {
  std::array<Eigen::Vector3d, 3> edges;
  Eigen::Vector3d w;
  double depth;
};

/// Where a ray sees a normal map.
struct NormalTextureSample {
  const NormalTexture* map = nullptr;
  double x = 0, y = 0;  ///< texel coordinates
  double level = 0;     ///< of the map's pyramid
};

/// What a camera ray sees.
struct Shade {
  double radiance = 0;  ///< linear light [-]
  double distance = 0;  ///< along Ray::direction [its length]; 0 = background
};

/// Where a ray intersects the plane of a triangle that is cut out.
struct CutoutSample {
  double x = 0, y = 0;  ///< texel coordinates of its alpha map
  double distance = 0;  ///< along Ray::direction [its length]; 0: not met
  double opacity = 0;   ///< opaque from 0.5 on
};

class MovingObject;
struct PatchLighting;

/// Everything that reflects or emits light, immutable after loading; all members are thread-safe
/// and deterministic. Visibility comes from Embree (float); the point that is seen and its radiance
/// are recomputed in double from the triangle, because float barycentrics alone cost microseconds
/// of time.
class Scene {
 public:
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  /// The nearest opaque triangle along each of at most 16 coherent rays; `triangles` has the same
  /// size.
  void visible(std::span<const Ray> rays, std::span<TriangleId> triangles) const;

  /// The same for one ray, in double precision throughout: exact next to edges, but many times
  /// slower. Builds the trees of collect() when first asked. In animated scenes, where these do not
  /// hold, as visible() has it.
  [[nodiscard]] TriangleId visible_exactly(const Ray& ray) const;
  /// The nearest of `triangles` along a ray, in double precision; kNothing where it intersects
  /// none.
  [[nodiscard]] TriangleId nearest_among(std::span<const TriangleId> triangles,
                                         const Ray& ray) const;

  /// Radiance and distance where `ray` intersects the plane of `triangle` (inside it or, for a ray
  /// that leaves it by a hair, just outside); the background for kNothing. Lights cast shadows.
  [[nodiscard]] Shade shade(const Ray& ray, TriangleId triangle) const;
  /// The same with the texture's mean over the ray's footprint.
  [[nodiscard]] Shade shade(const Ray& ray, TriangleId triangle,
                            const RayDifferential& differential) const;

  /// Where `ray` intersects the plane of `triangle`, as shade() has it, in terms of its texture and
  /// without the lights (irradiance 1).
  [[nodiscard]] SurfaceSample sample_surface(const Ray& ray, TriangleId triangle) const;
  /// The same at the level of the texture's pyramid whose texels are as large as the footprint of
  /// the ray on the triangle's plane, along its longer side; 0 where it is smaller than a texel,
  /// and for the background:
  ///   level = max(0, log2 max(|J right|, |J down|)),   J = t grad(x, y) (1 - d n^T / (n . d))
  /// with t the distance, d the direction and n the plane's normal. Continuous in the ray.
  [[nodiscard]] SurfaceSample sample_surface(const Ray& ray, TriangleId triangle,
                                             const RayDifferential& differential) const;
  /// sample_surface() at once for all rays of a camera at `position`, given in its own frame.
  /// `triangle` is static.
  [[nodiscard]] TexelHomography texel_homography(TriangleId triangle,
                                                 const Eigen::Vector3d& position,
                                                 const Eigen::Matrix3d& world_from_camera) const;
  /// Finds the lights that nothing hides from the points of at most 16 samples along `rays` at
  /// `triangles` (spots whether or not a point is in their cone), the irradiance (1 in an unlit
  /// scene and for the background) and what is mirrored.
  void illuminate(std::span<const Ray> rays, std::span<const TriangleId> triangles,
                  std::span<SurfaceSample> samples) const;
  /// The lights alone, of at most 16 samples of triangles: those that `known`, one per sample,
  /// leaves open are looked for.
  void find_lights(std::span<const Ray> rays, std::span<const TriangleId> triangles,
                   std::span<const SurfaceSample> samples, std::span<const KnownLights> known,
                   std::span<LightSet> lights) const;
  /// Sets the irradiance of a sample, and what it mirrors, if just `surface.lights` light it:
  /// without shadow rays.
  void set_light(const Ray& ray, TriangleId triangle, SurfaceSample& surface) const;
  [[nodiscard]] bool is_lit() const;
  /// The flickers of its lights, each once; empty in steady light.
  [[nodiscard]] std::span<const Flicker> flickers() const;
  /// Finds where `lights` light a static triangle on the straight way between two of its points, on
  /// the side of `eye`: in double precision, without the rounding of shadow rays. Spots light
  /// outside of their cones, too. False where that is not known: among moving objects and cut-outs.
  [[nodiscard]] bool find_lighting_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                           const Eigen::Vector3d& eye, TriangleId triangle,
                                           LightSet lights, PatchLighting& lighting) const;
  /// Whether some of its lights are spots, whose irradiance changes fast at the edge of their cone.
  [[nodiscard]] bool has_spots() const;
  /// Bounds of the irradiance of what is seen of `triangle` from one ray to a later one, and of
  /// what it mirrors, if just `lights` light it: Illumination::irradiance_range(). `from` and `to`
  /// are the samples of both rays, `middle_ray` is halfway in time. nullopt where one misses the
  /// triangle's plane. With a normal map, `mapped` bounds its vector on the way.
  [[nodiscard]] std::optional<SurfaceLightRange> light_range(
      const Ray& from_ray, const SurfaceSample& from, const Ray& middle_ray, const Ray& to_ray,
      const SurfaceSample& to, TriangleId triangle, LightSet lights,
      const VectorRange* mapped = nullptr) const;
  /// Whether a triangle mirrors lights.
  [[nodiscard]] bool is_glossy(TriangleId triangle) const;
  /// Whether a normal map bends the shading normal of a triangle, of any at all without one.
  [[nodiscard]] bool has_normal_map(TriangleId triangle) const;
  [[nodiscard]] bool has_normal_maps() const;
  /// What `seen` is on the normal map of such a triangle.
  [[nodiscard]] NormalTextureSample sample_normal_map(const Ray& ray, TriangleId triangle,
                                                      const SurfaceSample& seen) const;
  /// Which lights reach the part of `triangle` that a frustum sees on its way through `frusta` (at
  /// most 4): known for the whole triangle, or else put into `lighting`. nullptr where that is not
  /// known: for moving triangles and among moving objects, where light goes through cutouts, and
  /// where more than `most` triangles may occlude a light.
  [[nodiscard]] const PatchLighting* find_lighting(TriangleId triangle,
                                                   std::span<const Frustum> frusta,
                                                   std::size_t most, PatchLighting& lighting) const;

  /// Object (index into the scene's mesh list) of a triangle.
  [[nodiscard]] std::uint32_t object(TriangleId triangle) const;
  /// Instance of a triangle, from 1 on; 0 for kNothing.
  [[nodiscard]] std::uint16_t instance(TriangleId triangle) const;
  /// All instances: number k is item k - 1.
  [[nodiscard]] std::span<const SceneInstance> instances() const;
  /// Class of an instance; 0, no class, for 0.
  [[nodiscard]] std::uint8_t class_of(std::uint16_t instance) const;
  /// Unit normal of the plane of a triangle in the world at the ray's time, on the side that the
  /// ray comes from.
  [[nodiscard]] Eigen::Vector3d normal(const Ray& ray, TriangleId triangle) const;

  /// The objects with a motion of their own, in the order of the mesh list.
  [[nodiscard]] std::span<const MovingObject> moving_objects() const;
  /// The one that a triangle belongs to; nullptr where it is static, and for kNothing.
  [[nodiscard]] const MovingObject* moving_object(TriangleId triangle) const;
  [[nodiscard]] std::size_t triangle_count() const;

  /// Whether the vertices of some object move in its frame.
  [[nodiscard]] bool is_animated() const;
  /// Where the point of a triangle that `ray` sees is at `to_s`, in the world, as its object
  /// carries and deforms it. `triangle` is not kNothing.
  [[nodiscard]] Eigen::Vector3d carried_point(const Ray& ray, TriangleId triangle,
                                              double to_s) const;
  /// The velocity at `at_s` in the world, beside that of its object's frame, of the point of a
  /// triangle that `ray` sees. Zero where the object is rigid, and for kNothing.
  [[nodiscard]] Eigen::Vector3d deformation_velocity(const Ray& ray, TriangleId triangle,
                                                     double at_s) const;
  /// The first time between both at which the motion of a triangle's corners in its object's frame
  /// has a kink; at a jump just before and just after. nullopt where there is none.
  [[nodiscard]] std::optional<double> first_kink_s(TriangleId triangle, double from_s,
                                                   double to_s) const;

  /// Whether nothing but `triangle` is visible in a frustum that moves evenly through `frusta` (at
  /// most 5): it is opaque, static and fills them, and no other static triangle intersects them in
  /// front of its plane. For kNothing: whether none intersects them at all.
  [[nodiscard]] bool is_sole_visible(TriangleId triangle, std::span<const Frustum> frusta) const;

  /// The triangles, also of moving objects, that may intersect such frusta nearer than `farthest_m`
  /// of z depth, into `found`; false where there are more than `most`.
  [[nodiscard]] bool collect(std::span<const Frustum> frusta, double farthest_m, std::size_t most,
                             std::vector<TriangleId>& found) const;

  /// The edge functions of a triangle at `time_s` for all rays of a camera at `position`, given in
  /// its own frame.
  [[nodiscard]] EdgeFunctions edge_functions(TriangleId triangle, const Eigen::Vector3d& position,
                                             const Eigen::Matrix3d& world_from_camera,
                                             double time_s) const;

  /// Whether rays may go through holes of the triangle.
  [[nodiscard]] bool is_cut_out(TriangleId triangle) const;
  /// Of such a triangle.
  [[nodiscard]] CutoutSample sample_cutout(const Ray& ray, TriangleId triangle) const;

  /// The double-precision hit test behind visible(), for callers that hold a likely triangle: true
  /// when `ray` passes through `triangle` (edges included). Says nothing about occluders.
  [[nodiscard]] bool intersects(const Ray& ray, TriangleId triangle) const;
  /// Smallest barycentric coordinate of the point where `ray` intersects the plane of `triangle`:
  /// how far it passes inside the edges, negative outside. -1 where it does not meet the plane, and
  /// for kNothing.
  [[nodiscard]] double min_barycentric(const Ray& ray, TriangleId triangle) const;

 private:
  struct State;
  explicit Scene(std::unique_ptr<State> state);
  friend class SceneBuilder;
  std::unique_ptr<State> state_;
};

}  // namespace saccade
