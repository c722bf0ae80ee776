#pragma once

#include <cmath>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/check.h"
#include "core/event.h"
#include "core/image.h"
#include "core/rigid3.h"
#include "core/trajectory.h"
#include "estimator/run/pose_table.h"

namespace saccade {

/// An event where a camera of constant orientation would have seen it.
struct StabilizedEvent {
  float x = 0, y = 0;  ///< undistorted, sub-pixel [px]; may lie outside the image
  Event source;        ///< as recorded
};

/// Warps events and images from the camera's orientation at their own time to another orientation,
///   u' = K R_(s,k) K^-1 u                                                                  (3.19)
/// and removes the lens distortion. Exact for distant scenes and for purely rotating cameras.
class Stabilizer {
 public:
  /// `camera` with its lens; `world_from_camera` is not empty and outlives this; its positions are
  /// ignored.
  Stabilizer(const PinholeCamera& camera, const Trajectory& world_from_camera)
      : camera_(camera), undistortion_(camera), world_from_camera_(world_from_camera) {
    SACCADE_CHECK(!world_from_camera.empty());
  }

  /// Warps every event by the orientation at its own time (thesis 3.3); beyond the trajectory's
  /// ends the orientation is held. `world_from_smoothed`: the orientation to warp to.
  [[nodiscard]] std::vector<StabilizedEvent> stabilize(
      std::span<const Event> events, const Eigen::Quaterniond& world_from_smoothed) const {
    std::vector<StabilizedEvent> stabilized;
    if (events.empty()) return stabilized;
    stabilized.reserve(events.size());
    const PoseTable table(world_from_camera_, Rigid3(world_from_smoothed.conjugate(), {0, 0, 0}),
                          events.front().t_ns, events.back().t_ns);
    const auto fx = static_cast<float>(camera_.fx), fy = static_cast<float>(camera_.fy);
    const auto cx = static_cast<float>(camera_.cx), cy = static_cast<float>(camera_.cy);
    for (const Event& event : events) {
      const Eigen::Vector2f& pixel = undistortion_(event.x, event.y);
      const Eigen::Vector3f ray((pixel.x() - cx) / fx, (pixel.y() - cy) / fy, 1);
      const Eigen::Vector3f rotated = table.at(event.t_ns).r * ray;  // (3.19)
      // Behind the stabilized view there is no image point.
      const float scale = rotated.z() > 0 ? 1 / rotated.z() : std::nanf("");
      stabilized.push_back({fx * rotated.x() * scale + cx, fy * rotated.y() * scale + cy, event});
    }
    return stabilized;
  }

  /// Warps an image that was taken at `t_s`; 0 outside the camera's view.
  [[nodiscard]] ImageF stabilize(const ImageF& image, double t_s,
                                 const Eigen::Quaterniond& world_from_smoothed) const {
    SACCADE_CHECK(image.width() == camera_.width && image.height() == camera_.height);
    const Eigen::Matrix3d camera_from_smoothed =
        (world_from_camera_.at_clamped(t_s).rotation().conjugate() * world_from_smoothed)
            .toRotationMatrix();
    ImageF stabilized(image.width(), image.height());
    for (int v = 0; v < image.height(); ++v)
      for (int u = 0; u < image.width(); ++u) {
        const Eigen::Vector3d ray = camera_from_smoothed * camera_.ray({u, v});  // (3.19)
        if (!(ray.z() > 0)) continue;
        const Eigen::Vector2d from = camera_.distort(camera_.project(ray));
        if (!is_inside(image, from.x(), from.y())) continue;
        stabilized(u, v) = static_cast<float>(sample(image, from.x(), from.y()));
      }
    return stabilized;
  }

 private:
  PinholeCamera camera_;
  UndistortionTable undistortion_;
  const Trajectory& world_from_camera_;
};

}  // namespace saccade
