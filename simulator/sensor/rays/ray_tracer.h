#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "simulator/motion/spline_table.h"
#include "simulator/scene/light/patch_lighting.h"
#include "simulator/scene/scene.h"
#include "simulator/sensor/motion/image_motion.h"
#include "simulator/sensor/visibility/opacity_search.h"
#include "simulator/sensor/rays/pixel_rays.h"
#include "simulator/sensor/rays/plane_sampler.h"
#include "simulator/sensor/signal/ray_sample.h"

namespace saccade {

/// What was spent and reached.
struct EventStatistics {
  std::uint64_t rays = 0;           ///< visibility rays
  std::uint64_t lit_points = 0;     ///< whose light was found, with a shadow ray to each lamp
  std::uint64_t surface_looks = 0;  ///< evaluations of a known triangle, without a visibility ray
  std::uint64_t lost = 0;           ///< events that met a full readout
  double time_bound_s = 0;          ///< widest final bracket around a crossing

  void add(const EventStatistics& other);
};

/// A triangle that a ray sees at some time.
struct Sighting {
  TriangleId triangle;
  double t_s;
};

/// How the rays of a camera see the scene at any time of a stretch of its motion. Counts what it
/// does.
class RayTracer {
 public:
  /// Rays that are traced together at most.
  static constexpr std::size_t kPacket = 16;

  /// All outlive the tracer. With `footprints` textures are filtered over the share of a pixel that
  /// each of its rays stands for; nullptr: they are seen at points.
  RayTracer(const Scene& scene, EventStatistics& statistics, const PixelRays* footprints = nullptr)
      : scene_(scene), statistics_(statistics), footprints_(footprints) {}

  /// The motion during what follows; outlives it.
  void use(const SplineTable& poses) { poses_ = &poses; }

  /// All triangles that rays can meet in what follows, as far as a search found them; none: not
  /// known. Outlives it.
  void use(std::span<const TriangleId> within_reach) { within_reach_ = within_reach; }

  /// What follows is between `from_s` and `to_s`, within the `outline` of some rays: the lamps of
  /// what can be seen there are found once for all of it.
  void use(const std::array<Eigen::Vector3d, 4>& outline, double from_s, double to_s);

  [[nodiscard]] bool is_lit() const { return scene_.is_lit(); }

  /// How the lamps light what is seen of a triangle there; nullptr where that is not known, and for
  /// kNothing. Valid until the next call.
  [[nodiscard]] const PatchLight* light_of(TriangleId triangle);
  /// The point of the triangle's plane that a ray meets; NaN where it meets none.
  [[nodiscard]] Eigen::Vector3d point_at(const Eigen::Vector3d& direction, TriangleId triangle,
                                         double t_s) const;

  /// The visible triangles of at most kPacket rays of one instant.
  void find_triangles(std::span<const Eigen::Vector3d> directions, double t_s,
                      std::span<TriangleId> triangles);
  /// What rays of one instant see, found in double precision: the nearest of the triangles within
  /// reach, or where they meet none of these, of the scene.
  void trace(std::span<const Eigen::Vector3d> directions, double t_s, std::span<RayView> views);

  /// What rays of one instant see, the visible triangles given.
  void see(std::span<const Eigen::Vector3d> directions, std::span<const TriangleId> triangles,
           double t_s, std::span<RayView> views);

  /// Of what they see.
  [[nodiscard]] InverseDepthRange inverse_depths(std::span<const Eigen::Vector3d> directions,
                                                 std::span<const TriangleId> triangles,
                                                 double t_s) const;

  /// Whether a triangle stands still in an unlit scene.
  [[nodiscard]] bool is_plane(TriangleId triangle) const {
    return triangle != kNothing && !is_lit() && scene_.moving_object(triangle) == nullptr;
  }
  /// How all rays see such a triangle at an instant, taken to be visible.
  [[nodiscard]] PlaneView plane_view(TriangleId triangle, double t_s) const;

  /// Whether from `from_s` to `to_s` nothing but `triangle` can be seen within the `outline` of
  /// some rays, moving objects apart.
  [[nodiscard]] bool is_alone(TriangleId triangle, const std::array<Eigen::Vector3d, 4>& outline,
                              double from_s, double to_s) const;

  /// The triangles that may come into view within the `outline` of some rays, nearer than
  /// `farthest_m`, into `found`; false where there are more than `most`.
  [[nodiscard]] bool collect(const std::array<Eigen::Vector3d, 4>& outline, double farthest_m,
                             double from_s, double to_s, std::size_t most,
                             std::vector<TriangleId>& found) const;

  /// The stretches, in order, in which a triangle that is cut out stops a ray or lets it through
  /// while the ray is inside its edges.
  [[nodiscard]] std::vector<OpaqueStretch> find_holes(const Eigen::Vector3d& direction,
                                                      TriangleId triangle, double from_s,
                                                      double to_s) const;

  /// Whether the ray meets `triangle` first of some.
  [[nodiscard]] bool sees(const Eigen::Vector3d& direction, TriangleId triangle,
                          std::span<const TriangleId> among, double t_s) const;

  [[nodiscard]] CameraFrame camera_at(double t_s) const { return poses_->at(t_s); }

  /// What a ray sees of a triangle, taken to be visible.
  [[nodiscard]] RayView view(const Eigen::Vector3d& direction, TriangleId triangle, double t_s);
  /// The same if just these lamps light the place: without shadow rays.
  [[nodiscard]] RayView view(const Eigen::Vector3d& direction, TriangleId triangle, LampSet lamps,
                             double t_s);
  /// The same with irradiance 1.
  [[nodiscard]] RayView unlit_view(const Eigen::Vector3d& direction, TriangleId triangle,
                                   double t_s);

  /// When the visible triangle changes between two sightings, to `tolerance_s`, if through an edge
  /// the first is left or else the second entered; NaN if neither.
  [[nodiscard]] double change_s(const Eigen::Vector3d& direction, const Sighting& from,
                                const Sighting& to, double tolerance_s) const;

  /// Whether at every time between two sightings a ray meets one of both triangles or the other, so
  /// that nothing behind them shows in between.
  [[nodiscard]] bool is_covered(const Eigen::Vector3d& direction, const Sighting& from,
                                const Sighting& to, double tolerance_s) const;

  /// Whether a ray meets the edges of both triangles in one point, as with neighbours in a mesh.
  [[nodiscard]] bool is_crease(const Eigen::Vector3d& direction, TriangleId a, TriangleId b,
                               double t_s) const;

 private:
  struct KnownLight {
    TriangleId triangle;
    const PatchLight* whole;  ///< of the whole triangle
    bool is_known;            ///< if just for what follows
    PatchLight patch;

    [[nodiscard]] const PatchLight* light() const {
      return whole != nullptr ? whole : is_known ? &patch : nullptr;
    }
  };

  [[nodiscard]] Ray ray_at(const Eigen::Vector3d& direction, double t_s) const;
  [[nodiscard]] double inside(const Eigen::Vector3d& direction, TriangleId triangle,
                              double t_s) const;
  /// How far from `t_s` the look lies that gives the rates: backwards at the end of the stretch,
  /// where an object may come to rest.
  [[nodiscard]] double difference_s(double t_s) const;
  /// Of 30 ms at most: so many that what moves between two of them does so evenly.
  using Sweep = std::array<SightPyramid, 5>;
  [[nodiscard]] Sweep sweep_of(const std::array<Eigen::Vector3d, 4>& outline, double from_s,
                               double to_s) const;
  [[nodiscard]] SightPyramid pyramid_at(const std::array<Eigen::Vector3d, 4>& outline,
                                        double t_s) const;
  /// Of the ray `direction` at an instant, at which the camera is `camera`.
  [[nodiscard]] SurfaceLook surface_look(const Eigen::Vector3d& direction, TriangleId triangle,
                                         const CameraFrame& camera, double t_s) const;
  /// Finds the light for at most kPacket views: with the triangles between a patch and the lamps
  /// where these are known, else with shadow rays.
  void illuminate(std::span<const Ray> rays, std::span<RayView> views);

  const Scene& scene_;
  EventStatistics& statistics_;
  const PixelRays* footprints_;
  const SplineTable* poses_ = nullptr;
  std::span<const TriangleId> within_reach_;
  Sweep sweep_;                     ///< of what follows
  std::vector<KnownLight> lights_;  ///< of what has been seen in it so far, `light_count_` of them
  std::size_t light_count_ = 0;
  bool finds_lights_ = false;
};

}  // namespace saccade
