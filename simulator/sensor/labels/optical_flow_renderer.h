#pragma once

#include "core/camera.h"
#include "core/io/labels/optical_flow_file.h"
#include "core/trajectory.h"
#include "simulator/scene/scene.h"
#include "simulator/sensor/rays/pixel_rays.h"

namespace saccade {

/// Optical flow between two instants: where the point that the ray through a pixel's centre meets at
/// the first is in the image of the second, with its own motion where its object moves; the
/// background is infinitely far. In parallel over tiles.
class OpticalFlowRenderer {
 public:
  /// `scene` must outlive the renderer.
  OpticalFlowRenderer(const Scene& scene, const PinholeCamera& camera)
      : scene_(scene), rays_(camera, 1) {}

  /// A point is occluded where the ray from the camera at `to` meets something nearer by more than
  /// 1e-4 of its distance.
  [[nodiscard]] OpticalFlow flow(const StampedPose& from, const StampedPose& to) const;
  /// Both ways.
  [[nodiscard]] OpticalFlowPair pair(const StampedPose& first, const StampedPose& second) const {
    return {flow(first, second), flow(second, first)};
  }

 private:
  const Scene& scene_;
  PixelRays rays_;
};

}  // namespace saccade
