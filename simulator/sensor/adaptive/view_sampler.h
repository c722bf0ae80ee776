#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include <Eigen/Core>

#include "simulator/motion/spline_table.h"
#include "simulator/scene/light/patch_lighting.h"
#include "simulator/scene/scene.h"
#include "simulator/sensor/adaptive/surface_arc.h"
#include "simulator/sensor/adaptive/view_sample.h"
#include "simulator/sensor/event_options.h"
#include "simulator/sensor/rays/pixel_rays.h"
#include "simulator/sensor/rays/ray_tracer.h"

namespace saccade {

/// A pixel at an instant that is to be sampled.
struct SampleRequest {
  std::size_t pixel;  ///< within the tile
  double t_s;
};

/// Samples pixels of one tile at any times of a slice with rays, up to kRayPacket in a packet,
/// whatever their times are. Counts what it does.
class ViewSampler {
 public:
  /// All outlive the sampler.
  ViewSampler(const Scene& scene, const PixelRays& rays, const EventOptions& options,
              std::size_t tile, EventStatistics& statistics)
      : scene_(scene), rays_(rays), options_(options), tile_(tile), statistics_(statistics) {}

  /// The camera's motion during what follows; outlives it.
  void set_poses(const SplineTable& poses) {
    poses_ = &poses;
    way_.triangle = kNothing;
    camera_s_ = std::numeric_limits<double>::quiet_NaN();
  }

  /// What the pixels see, by rays, shadow rays included.
  void trace(std::span<const SampleRequest> requests, std::span<ViewSample> samples);

  /// The triangles that all pixels of the tile, with one ray each, see at `t_s`.
  void look(double t_s, std::span<TriangleId> triangles);

  /// Which of `among` light what a pixel with one ray sees of the triangle of `like`, its other
  /// lights being the same, at the times of `requests`, at most kRayPacket of them.
  void look_at_lights(std::span<const SampleRequest> requests,
                      std::span<const ViewSample* const> like, std::span<const LightSet> among,
                      std::span<LightSet> lights);

  /// What a pixel with one ray sees at `t_s` just between two samples if it is the triangle of one
  /// of them, with its lights: without a ray and in double precision, which single precision may
  /// confuse next to their edges. Neither is hit: nullopt.
  [[nodiscard]] std::optional<ViewSample> resample(const SampleRequest& request,
                                                   const ViewSample& before,
                                                   const ViewSample& after);
  /// What a pixel with one ray sees at `t_s` if it sees the triangle and the lights of `like`, as
  /// it does just before and just after: without a ray.
  [[nodiscard]] ViewSample resample(const SampleRequest& request, const ViewSample& like);
  /// The same under other lights.
  [[nodiscard]] ViewSample resample(const SampleRequest& request, const ViewSample& like,
                                    LightSet lights);

  /// How much what the first ray sees mirrored of the lights may change between two samples of one
  /// triangle under the same lights, by its bounds.
  [[nodiscard]] double mirrored_span(std::size_t pixel, const ViewSample& from,
                                     const ViewSample& to);
  /// What a pixel with one ray sees from one sample to a later one if it sees the same triangle and
  /// the same lights all the time: without a ray.
  [[nodiscard]] SurfaceArc arc(std::size_t pixel, const ViewSample& from, const ViewSample& to);

  /// Finds in double precision where `lights` light what a pixel with one ray sees between two
  /// samples of one triangle, close to each other, for settle_lights(); false where that is not
  /// known. Single precision, in which shadow rays are traced, mistakes the edge of a shadow by up
  /// to a thousandth of a pixel.
  [[nodiscard]] bool find_lights_between(std::size_t pixel, const ViewSample& from,
                                         const ViewSample& to, LightSet lights);
  /// Corrects a sample between two for which `lights` were found.
  void settle_lights(std::size_t pixel, LightSet lights, ViewSample& sample);

  [[nodiscard]] std::size_t rays_per_pixel() const { return rays_.rays_per_pixel(); }

 private:
  /// What find_lights_between() found last.
  struct Way {
    std::size_t pixel = 0;
    TriangleId triangle = kNothing;  ///< kNothing: nothing yet
    LightSet lights = 0;
    double from_s = 0, to_s = 0;
    PatchLighting lighting;
  };

  [[nodiscard]] std::span<const Eigen::Vector3d> directions(std::size_t pixel) const {
    return rays_.rays(tile_).subspan(pixel * rays_.rays_per_pixel(), rays_.rays_per_pixel());
  }
  /// Of a time that is often asked for more than once in a row.
  [[nodiscard]] const CameraFrame& camera_at(double t_s) {
    if (t_s != camera_s_) {
      camera_ = poses_->at(t_s);
      camera_s_ = t_s;
    }
    return camera_;
  }
  [[nodiscard]] SurfaceSample surface(const CameraFrame& camera, const Eigen::Vector3d& direction,
                                      const Ray& ray, TriangleId triangle) const;
  /// The point that a pixel with one ray sees, in the world.
  [[nodiscard]] Eigen::Vector3d point_of(std::size_t pixel, const ViewSample& sample);
  /// Adds where a ray, the first of its pixel, sees a normal map.
  void add_normal_map(const Ray& ray, const SurfaceSample& seen, ViewSample& sample) const;
  /// Along the first ray of a pixel, on the triangle and under the lights of `like`.
  [[nodiscard]] SurfaceSample surface_like(const SampleRequest& request, const ViewSample& like);

  const Scene& scene_;
  const PixelRays& rays_;
  const EventOptions& options_;
  std::size_t tile_;
  EventStatistics& statistics_;
  const SplineTable* poses_ = nullptr;
  CameraFrame camera_;
  double camera_s_ = std::numeric_limits<double>::quiet_NaN();  ///< of camera_
  Way way_;
};

}  // namespace saccade
