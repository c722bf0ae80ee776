#pragma once

#include <span>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/io/images/exr_file.h"
#include "core/spline/spline.h"
#include "core/trajectory.h"
#include "simulator/scene/scene.h"
#include "simulator/sensor/event_options.h"
#include "simulator/sensor/rays/pixel_rays.h"

namespace saccade {

/// The exposure of one row of an image: the mean of the views at `poses`, each of which stands for
/// `span_s` around its time.
struct RowExposure {
  std::vector<StampedPose> poses;
  double span_s = 0;
};

/// Whole images of the scene at given poses, in parallel over tiles. Radiance is the mean over a
/// pixel's rays, as the event pixels see it; depth and motion are those of the ray through the
/// pixel's centre.
class ImageRenderer {
 public:
  /// `scene` must outlive the renderer; `rays_per_pixel`: 1, 4 or 16; `side_px` as PixelRays has it.
  ImageRenderer(const Scene& scene, const PinholeCamera& camera, int rays_per_pixel,
                TextureFilter filter = TextureFilter::kBilinear, double side_px = 1);

  /// Mean linear radiance over the poses (one: a sharp image; several: the exposure's blur), each
  /// of which stands for `span_s` around its time: over that flickering light is averaged.
  [[nodiscard]] ImageF radiance(std::span<const StampedPose> poses, double span_s = 0) const;

  /// The same with a rolling shutter: every row of the image with an exposure of its own, all of
  /// equally many poses.
  [[nodiscard]] ImageF radiance(std::span<const RowExposure> rows) const;

  /// z depth [m]; 0 = background.
  [[nodiscard]] ImageF depth(const StampedPose& pose) const;

  /// Motion field [px/s] on the distorted image of a camera that is in `state` at `t_s`; the
  /// background is infinitely far, so only rotation moves it, and moving objects have motions of
  /// their own besides, as have the points of animated ones.
  [[nodiscard]] FlowField flow(const SplineState& state, double t_s) const;

  [[nodiscard]] const PinholeCamera& camera() const { return radiance_rays_.camera(); }

 private:
  /// What a radiance ray, given in the camera's frame, sees of a triangle.
  [[nodiscard]] double radiance_of(const Ray& ray, TriangleId triangle,
                                   const Eigen::Matrix3d& world_from_camera,
                                   const Eigen::Vector3d& direction) const;

  const Scene& scene_;
  TextureFilter filter_;
  PixelRays radiance_rays_;
  PixelRays centre_rays_;
};

}  // namespace saccade
