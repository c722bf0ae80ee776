#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "simulator/motion/spline_table.h"
#include "simulator/scene/light/patch_lighting.h"
#include "simulator/scene/scene.h"
#include "simulator/sensor/motion/image_motion.h"
#include "simulator/sensor/rays/pixel_rays.h"
#include "simulator/sensor/rays/plane_sampler.h"
#include "simulator/sensor/signal/cell_bounds.h"
#include "simulator/sensor/signal/ray_sample.h"
#include "simulator/sensor/visibility/opacity_search.h"

namespace saccade {

/// What was spent and reached.
struct EventStatistics {
  std::uint64_t rays = 0;             ///< visibility rays
  std::uint64_t lit_points = 0;       ///< shaded points, with a shadow ray to each light
  std::uint64_t surface_samples = 0;  ///< samples of a known triangle, without a visibility ray
  std::uint64_t lost = 0;             ///< events that met a full readout
  double time_bound_s = 0;            ///< widest final bracket around a crossing

  void add(const EventStatistics& other);
};

/// A triangle that a ray sees at some time.
struct VisibleTriangle {
  TriangleId triangle;
  double t_s;
};

/// How the rays of a camera see the scene at any time of an interval of its motion. Counts what it
/// does.
class RayTracer {
 public:
  /// All outlive the tracer. With `footprints` textures are filtered over the fraction of a pixel
  /// that each of its rays stands for; nullptr: they are seen at points.
  RayTracer(const Scene& scene, EventStatistics& statistics, const PixelRays* footprints = nullptr)
      : scene_(scene),
        statistics_(statistics),
        footprints_(footprints),
        has_varying_light_(!scene.flickers().empty() || scene.has_spots()),
        has_normal_maps_(scene.has_normal_maps()) {}

  /// The motion during what follows; outlives it.
  void set_poses(const SplineTable& poses) { poses_ = &poses; }

  /// All triangles that rays can meet in what follows, as far as a search found them; none: not
  /// known. Outlives it.
  void set_candidates(std::span<const TriangleId> candidates) { candidates_ = candidates; }

  /// What follows is between `from_s` and `to_s`, within the `outline` of some rays: the lights of
  /// what can be seen there are found once for all of it.
  void set_region(const std::array<Eigen::Vector3d, 4>& outline, double from_s, double to_s);

  /// The lights on what was seen of a triangle.
  struct KnownLighting {
    TriangleId triangle;
    const PatchLighting* whole;  ///< of the whole triangle
    bool is_known;               ///< if just for what follows
    PatchLighting patch;

    [[nodiscard]] const PatchLighting* lighting() const {
      return whole != nullptr ? whole : is_known ? &patch : nullptr;
    }
  };
  using Memory = std::vector<KnownLighting>;
  /// Exchanges what was found for a region for what another tracer has left; the next call is
  /// set_region().
  void swap(Memory& memory) {
    std::swap(known_, memory);
    lighting_count_ = 0;
    candidates_ = {};
  }

  [[nodiscard]] bool is_lit() const { return scene_.is_lit(); }

  /// How the lights light what is seen of a triangle there; nullptr where that is not known, and
  /// for kNothing. Valid until the next call.
  [[nodiscard]] const PatchLighting* lighting_of(TriangleId triangle);
  /// The point of the triangle's plane that a ray intersects; NaN where it intersects none.
  [[nodiscard]] Eigen::Vector3d point_at(const Eigen::Vector3d& direction, TriangleId triangle,
                                         double t_s) const;

  /// The visible triangles of at most kRayPacket rays of one instant.
  void find_triangles(std::span<const Eigen::Vector3d> directions, double t_s,
                      std::span<TriangleId> triangles);
  /// What rays of one instant see, found in double precision: the nearest of the triangles within
  /// reach, or where they meet none of these, of the scene.
  void trace(std::span<const Eigen::Vector3d> directions, double t_s, std::span<RaySample> samples);

  /// What rays of one instant see, the visible triangles given.
  void sample(std::span<const Eigen::Vector3d> directions, std::span<const TriangleId> triangles,
              double t_s, std::span<RaySample> samples);

  /// Of what they see.
  [[nodiscard]] InverseDepthRange inverse_depths(std::span<const Eigen::Vector3d> directions,
                                                 std::span<const TriangleId> triangles,
                                                 double t_s) const;

  /// Whether a triangle is static in an unlit scene.
  [[nodiscard]] bool is_plane(TriangleId triangle) const {
    return triangle != kNothing && !is_lit() && scene_.moving_object(triangle) == nullptr;
  }
  /// How all rays see such a triangle at an instant, taken to be visible.
  [[nodiscard]] PlaneSampler plane_sampler(TriangleId triangle, double t_s) const;

  /// Whether from `from_s` to `to_s` nothing but `triangle` can be seen within the `outline` of
  /// some rays, moving objects apart.
  [[nodiscard]] bool is_sole_visible(TriangleId triangle,
                                     const std::array<Eigen::Vector3d, 4>& outline, double from_s,
                                     double to_s) const;

  /// The triangles that may come into view within the `outline` of some rays, nearer than
  /// `farthest_m`, into `found`; false where there are more than `most`.
  [[nodiscard]] bool collect(const std::array<Eigen::Vector3d, 4>& outline, double farthest_m,
                             double from_s, double to_s, std::size_t most,
                             std::vector<TriangleId>& found) const;

  /// The intervals, in order, in which a triangle that is cut out stops a ray or lets it through
  /// while the ray is inside its edges.
  [[nodiscard]] std::vector<OpacityInterval> find_opacity_intervals(
      const Eigen::Vector3d& direction, TriangleId triangle, double from_s, double to_s) const;

  /// Whether the ray intersects `triangle` first of some.
  [[nodiscard]] bool is_nearest(const Eigen::Vector3d& direction, TriangleId triangle,
                                std::span<const TriangleId> among, double t_s) const;

  [[nodiscard]] CameraFrame camera_at(double t_s) const { return poses_->at(t_s); }

  /// What a ray sees of a triangle, taken to be visible.
  [[nodiscard]] RaySample sample(const Eigen::Vector3d& direction, TriangleId triangle, double t_s);
  /// The same if just these lights light the point: without shadow rays.
  [[nodiscard]] RaySample sample(const Eigen::Vector3d& direction, TriangleId triangle,
                                 LightSet lights, double t_s);
  /// The same with irradiance 1.
  [[nodiscard]] RaySample sample_unlit(const Eigen::Vector3d& direction, TriangleId triangle,
                                       double t_s);

  /// radiance_range() of a ray that sees one triangle from `from_s` to `to_s`, in light that may
  /// flicker or come from spots, on normal maps, and on glossy surfaces.
  [[nodiscard]] RadianceRange radiance_range(const Eigen::Vector3d& direction,
                                             const RaySample& from, double from_s,
                                             const RaySample& to, double to_s) const {
    return has_varying_light_ || scene_.is_glossy(from.triangle) ||
                   (has_normal_maps_ && scene_.has_normal_map(from.triangle))
               ? varying_light_range(direction, from, from_s, to, to_s)
               : saccade::radiance_range(from, to, to_s - from_s);
  }

  /// split_fraction() of a ray that sees one triangle from `from_s` to `to_s`: the borders of a normal
  /// map's texels count as well.
  [[nodiscard]] double split_fraction(const Eigen::Vector3d& direction, const RaySample& from,
                                      double from_s, const RaySample& to, double to_s) const;

  /// When a ray's visible triangle changes from `from` to `to`, within `tolerance_s`: where the ray
  /// leaves the first or else enters the second; NaN if neither.
  [[nodiscard]] double change_s(const Eigen::Vector3d& direction, const VisibleTriangle& from,
                                const VisibleTriangle& to, double tolerance_s) const;

  /// When within `span` a ray crosses the edge of a triangle, from about where it does as a fraction
  /// of the span, within `tolerance_s`; NaN where the search goes astray.
  [[nodiscard]] double change_near_s(const Eigen::Vector3d& direction, TriangleId triangle,
                                     const Interval& span, double guess, double tolerance_s) const;

  /// Whether at every time between `from` and `to` the ray intersects at least one of the two
  /// triangles, so that nothing behind them shows in between.
  [[nodiscard]] bool is_covered(const Eigen::Vector3d& direction, const VisibleTriangle& from,
                                const VisibleTriangle& to, double tolerance_s) const;

  /// Whether a ray intersects the edges of both triangles in one point, as with neighbours in a
  /// mesh.
  [[nodiscard]] bool is_crease(const Eigen::Vector3d& direction, TriangleId a, TriangleId b,
                               double t_s) const;

 private:
  /// With bounds of the irradiance, which need not stay near a line.
  [[nodiscard]] RadianceRange varying_light_range(const Eigen::Vector3d& direction,
                                                  const RaySample& from, double from_s,
                                                  const RaySample& to, double to_s) const;
  /// Bounds of the vector of the normal map that a ray sees between two samples of one triangle;
  /// nullopt where it comes too far over it.
  [[nodiscard]] std::optional<VectorRange> normal_map_range(const Eigen::Vector3d& direction,
                                                            const RaySample& from, double from_s,
                                                            const RaySample& to, double to_s) const;
  /// Where a ray sees the normal map of a triangle, and how that moves; its texture is left out.
  [[nodiscard]] RaySample normal_map_sample(const Eigen::Vector3d& direction, const RaySample& seen,
                                            double t_s) const;
  [[nodiscard]] Ray ray_at(const Eigen::Vector3d& direction, double t_s) const;
  [[nodiscard]] double min_barycentric(const Eigen::Vector3d& direction, TriangleId triangle,
                                       double t_s) const;
  /// How far from `t_s` the sample lies that gives the rates: backwards at the end of the interval,
  /// where an object may come to rest.
  [[nodiscard]] double difference_s(double t_s) const;
  /// Of 30 ms at most: so many that what moves between two of them does so evenly.
  using Frusta = std::array<Frustum, 5>;
  [[nodiscard]] Frusta frusta_over(const std::array<Eigen::Vector3d, 4>& outline, double from_s,
                                   double to_s) const;
  [[nodiscard]] Frustum frustum_at(const std::array<Eigen::Vector3d, 4>& outline, double t_s) const;
  /// Of the ray `direction` at an instant, at which the camera is `camera`.
  [[nodiscard]] SurfaceSample sample_surface(const Eigen::Vector3d& direction, TriangleId triangle,
                                             const CameraFrame& camera, double t_s) const;
  /// Finds the light for at most kRayPacket samples: with the triangles between a patch and the
  /// lights where these are known, else with shadow rays.
  void illuminate(std::span<const Ray> rays, std::span<RaySample> samples);

  const Scene& scene_;
  EventStatistics& statistics_;
  const PixelRays* footprints_;
  bool has_varying_light_;
  bool has_normal_maps_;
  const SplineTable* poses_ = nullptr;
  std::span<const TriangleId> candidates_;
  Frusta frusta_;  ///< of what follows
  std::vector<KnownLighting>
      known_;  ///< of what has been seen in it so far, `lighting_count_` of them
  std::size_t lighting_count_ = 0;
  bool finds_lighting_ = false;
};

}  // namespace saccade
