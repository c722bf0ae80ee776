#include "estimator/reconstruction/observations/panorama_projector.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace saccade {

PanoramaProjector::PanoramaProjector(const PinholeCamera& camera, const Panorama& panorama)
    : panorama_(panorama),
      rays_(camera.width, camera.height),
      scale_(static_cast<float>(panorama.pixels_per_radian())) {
  const PinholeCamera undistorted = camera.undistorted();
  const UndistortionTable table(camera);
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x)
      rays_(x, y) = undistorted.ray(table(x, y).cast<double>()).cast<float>();
}

std::optional<Reprojection> PanoramaProjector::find(int x, int y,
                                                    const CameraPose& world_from_camera,
                                                    float near) const {
  constexpr float kPi = std::numbers::pi_v<float>;
  const Eigen::Vector3f d = world_from_camera.r * rays_(x, y);
  // Panorama::pixel(), in float.
  Reprojection p;
  p.x = (kPi - std::atan2(d.y(), d.x())) * scale_ - 0.5F - static_cast<float>(panorama_.left);
  p.y = (kPi / 2 - std::atan2(d.z(), std::sqrt(d.x() * d.x() + d.y() * d.y()))) * scale_ - 0.5F -
        static_cast<float>(panorama_.top);
  const auto columns_around = static_cast<float>(panorama_.around);
  const auto last_column = static_cast<float>(panorama_.width - 1);
  const auto last_row = static_cast<float>(panorama_.height - 1);
  const bool wraps = panorama_.wraps();
  p.x -= columns_around * std::round((p.x - (wraps ? near : middle())) / columns_around);
  p.inverse_depth = 1;
  // A pole is half a pixel beyond the centre of its row.
  if (panorama_.top == 0) p.y = std::max(p.y, 0.0F);
  if (panorama_.top + panorama_.height == panorama_.around / 2) p.y = std::min(p.y, last_row);
  if (!(p.y >= 0 && p.y <= last_row)) return std::nullopt;
  if (!wraps && !(p.x >= 0 && p.x <= last_column)) return std::nullopt;
  return p;
}

double PanoramaProjector::moved_px(const CameraPose& world_from_camera,
                                   const CameraPose& earlier_from_world) const {
  constexpr int kEvery = 31;
  const Eigen::Matrix3f earlier_from_camera = earlier_from_world.r * world_from_camera.r;
  float furthest = 0;
  for (int y = kEvery / 2; y < rays_.height(); y += kEvery)
    for (int x = kEvery / 2; x < rays_.width(); x += kEvery) {
      const Eigen::Vector3f ray = rays_(x, y).normalized();
      furthest = std::max(furthest, (earlier_from_camera * ray - ray).norm());
    }
  return static_cast<double>(scale_ * furthest);
}

}  // namespace saccade
