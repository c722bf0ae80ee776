#pragma once

#include <optional>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/image.h"
#include "core/panorama.h"
#include "estimator/reconstruction/place_finder.h"

namespace saccade {

/// Finds the place in a panorama that a pixel of a camera that only turns sees: its direction,
/// which no depth is needed for. The panorama's world is the reference of all poses; where the
/// camera is does not count.
class DirectionFinder {
 public:
  DirectionFinder(const PinholeCamera& camera, const Panorama& panorama);

  /// nullopt outside the panorama. Of a panorama that wraps, in the turn whose x is the nearest to
  /// `near`.
  [[nodiscard]] std::optional<Place> find(int x, int y, const CameraPose& world_from_camera,
                                          float near) const;
  /// ... whose x is the nearest to the middle.
  [[nodiscard]] std::optional<Place> find(int x, int y, const CameraPose& world_from_camera) const {
    return find(x, y, world_from_camera, middle());
  }

  /// x of the panorama's middle.
  [[nodiscard]] float middle() const { return 0.5F * static_cast<float>(panorama_.width - 1); }

  /// How far what the camera sees was from there at an earlier pose: the furthest of a few points,
  /// an angle in pixels of the panorama.
  [[nodiscard]] double moved_px(const CameraPose& world_from_camera,
                                const CameraPose& earlier_from_world) const;

 private:
  Panorama panorama_;
  Image<Eigen::Vector3f> rays_;  ///< of the sensor's pixels, z = 1
  float scale_;                  ///< [px/rad]
};

}  // namespace saccade
