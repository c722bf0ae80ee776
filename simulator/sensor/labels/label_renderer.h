#pragma once

#include <vector>

#include "core/camera.h"
#include "core/io/labels/box_file.h"
#include "core/io/labels/label_images.h"
#include "core/trajectory.h"
#include "simulator/scene/scene.h"
#include "simulator/sensor/rays/pixel_rays.h"

namespace saccade {

/// Labels of whole images, each of what the ray through a pixel's centre meets, in parallel over
/// tiles.
class LabelRenderer {
 public:
  /// `scene` must outlive the renderer.
  LabelRenderer(const Scene& scene, const PinholeCamera& camera)
      : scene_(scene), rays_(camera, 1) {}

  [[nodiscard]] InstanceMask mask(const StampedPose& pose) const;

  /// In the camera's frame, of the triangles' planes.
  [[nodiscard]] NormalMap normals(const StampedPose& pose) const;

  /// The boxes of all instances in a mask of the same pose, in their order. For the visible
  /// fraction each ray goes on behind what it meets, from one thousandth of a per cent of the
  /// distance behind it on: instances that lie closer behind one another count as one.
  [[nodiscard]] std::vector<InstanceBox> boxes(const StampedPose& pose,
                                               const InstanceMask& mask) const;

 private:
  /// Of each instance the pixels that it would have alone.
  [[nodiscard]] std::vector<std::size_t> pixels_alone(const StampedPose& pose) const;

  const Scene& scene_;
  PixelRays rays_;
};

}  // namespace saccade
