#pragma once

#include <optional>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/image.h"
#include "core/panorama.h"
#include "estimator/reconstruction/observations/reprojector.h"

namespace saccade {

/// Projects the pixels of a rotating camera into a panorama: along their directions, for which no
/// depth is needed. The panorama's world is the reference of all poses; translation is ignored.
class PanoramaProjector {
 public:
  PanoramaProjector(const PinholeCamera& camera, const Panorama& panorama);

  /// nullopt outside the panorama. In a panorama that wraps, x is that of the revolution nearest to
  /// `near`.
  [[nodiscard]] std::optional<Reprojection> find(int x, int y, const CameraPose& world_from_camera,
                                                 float near) const;
  /// ... nearest to the middle.
  [[nodiscard]] std::optional<Reprojection> find(int x, int y,
                                                 const CameraPose& world_from_camera) const {
    return find(x, y, world_from_camera, middle());
  }

  /// x of the panorama's middle.
  [[nodiscard]] float middle() const { return 0.5F * static_cast<float>(panorama_.width - 1); }

  /// Image motion since an earlier pose: the maximum over a few directions, as an angle in pixels of
  /// the panorama.
  [[nodiscard]] double moved_px(const CameraPose& world_from_camera,
                                const CameraPose& earlier_from_world) const;

 private:
  Panorama panorama_;
  Image<Eigen::Vector3f> rays_;  ///< of the sensor's pixels, z = 1
  float scale_;                  ///< [px/rad]
};

}  // namespace saccade
