#pragma once

#include <span>

#include "core/camera.h"
#include "core/image.h"
#include "core/io/images/exr_file.h"
#include "core/spline/spline.h"
#include "simulator/scene/scene.h"
#include "simulator/sensor/event_options.h"
#include "simulator/sensor/rays/pixel_rays.h"

namespace saccade {

/// Whole images of the scene at given poses, in parallel over tiles. Radiance is the mean over a
/// pixel's rays, as the event pixels see it; depth and motion are those of the ray through the
/// pixel's centre.
class ImageRenderer {
 public:
  /// `scene` must outlive the renderer; `rays_per_pixel`: 1, 4 or 16.
  ImageRenderer(const Scene& scene, const PinholeCamera& camera, int rays_per_pixel,
                TextureFilter filter = TextureFilter::kBilinear);

  /// Mean linear radiance over the poses (one: a sharp image; several: the exposure's blur), each
  /// of which stands for `span_s` around its time: over that flickering light is averaged.
  [[nodiscard]] ImageF radiance(std::span<const StampedPose> poses, double span_s = 0) const;

  /// z depth [m]; 0 = background.
  [[nodiscard]] ImageF depth(const StampedPose& pose) const;

  /// Motion field [px/s] on the distorted image of a camera that is in `state` at `t_s`; the
  /// background is infinitely far, so only rotation moves it, and moving objects have motions of
  /// their own besides.
  [[nodiscard]] FlowField flow(const SplineState& state, double t_s) const;

  [[nodiscard]] const PinholeCamera& camera() const { return radiance_rays_.camera(); }

 private:
  const Scene& scene_;
  TextureFilter filter_;
  PixelRays radiance_rays_;
  PixelRays centre_rays_;
};

}  // namespace saccade
