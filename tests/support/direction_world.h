#pragma once

#include <filesystem>
#include <functional>

#include <Eigen/Geometry>

#include "core/camera.h"
#include "core/event.h"
#include "core/image.h"
#include "core/panorama.h"

namespace saccade::testing {

using OrientationFunction = std::function<Eigen::Quaterniond(double t_s)>;  ///< world_from_camera

/// A sky of waves with soft edges, infinitely far away, around a purely rotating camera.
class DirectionWorld {
 public:
  explicit DirectionWorld(PinholeCamera camera) : camera_(camera) {}

  [[nodiscard]] const PinholeCamera& camera() const { return camera_; }
  /// ln(intensity) in a direction, a unit vector.
  [[nodiscard]] static double log_intensity(const Eigen::Vector3d& direction);
  [[nodiscard]] static ImageF log_intensity(const Panorama& panorama);
  /// Events of an ideal sensor over [0, end_s]: the signal is sampled every ms and linear in
  /// between; in EventOrder.
  [[nodiscard]] Events simulate(const OrientationFunction& turning, double end_s,
                                double contrast) const;

 private:
  [[nodiscard]] ImageF view(const Eigen::Quaterniond& world_from_camera) const;

  PinholeCamera camera_;
};

/// 48 x 36 pixels, 44 degrees wide.
[[nodiscard]] PinholeCamera small_camera();

/// Horizontal at first and looking along longitude `start` [rad]; at rest until 0.1 s, then `rate`
/// rad/s to the left, nodding by 0.1 rad.
[[nodiscard]] OrientationFunction sweep(double start, double rate);

/// A dataset of it with a perfect inertial sensor in the camera's axes and panorama.exr; contrast
/// 0.15.
void write_sky_dataset(const std::filesystem::path& folder, const OrientationFunction& turning,
                       double end_s);

/// Correlation of two images on a mask.
[[nodiscard]] double correlation(const ImageF& a, const ImageF& b, const ImageU8& mask);

}  // namespace saccade::testing
