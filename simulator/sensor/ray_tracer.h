#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "simulator/motion/pose_table.h"
#include "simulator/scene/scene.h"
#include "simulator/sensor/ray_view.h"

namespace saccade {

/// What was spent and reached.
struct EventStatistics {
  std::uint64_t rays = 0;           ///< visibility rays
  std::uint64_t shadow_rays = 0;    ///< towards lights
  std::uint64_t surface_looks = 0;  ///< evaluations of a known triangle, without a visibility ray
  std::uint64_t stretches = 0;      ///< steps of pixels
  std::uint64_t certified = 0;      ///< of them those in which nothing can have fired
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

  /// Both outlive the tracer.
  RayTracer(const Scene& scene, EventStatistics& statistics)
      : scene_(scene), statistics_(statistics) {}

  /// The motion during what follows; outlives it.
  void use(const PoseTable& poses) { poses_ = &poses; }

  [[nodiscard]] bool is_lit() const { return scene_.is_lit(); }

  /// What at most kPacket rays of one instant see.
  void trace(std::span<const Eigen::Vector3d> directions, double t_s, std::span<RayView> views);

  /// What a ray sees of a triangle, taken to be visible.
  [[nodiscard]] RayView view(const Eigen::Vector3d& direction, TriangleId triangle, double t_s);

  /// When the visible triangle changes between two sightings, to `tolerance_s`, if through an edge
  /// the first is left or else the second entered; NaN if neither.
  [[nodiscard]] double change_s(const Eigen::Vector3d& direction, const Sighting& from,
                                const Sighting& to, double tolerance_s) const;

  /// Whether a ray meets the edges of both triangles in one point, as with neighbours in a mesh.
  [[nodiscard]] bool is_crease(const Eigen::Vector3d& direction, TriangleId a, TriangleId b,
                               double t_s) const;

 private:
  [[nodiscard]] Ray ray_at(const Eigen::Vector3d& direction, double t_s) const;
  [[nodiscard]] double inside(const Eigen::Vector3d& direction, TriangleId triangle,
                              double t_s) const;
  void illuminate(const Ray& ray, RayView& view);

  const Scene& scene_;
  EventStatistics& statistics_;
  const PoseTable* poses_ = nullptr;
};

}  // namespace saccade
