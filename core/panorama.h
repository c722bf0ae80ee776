#pragma once

#include <numbers>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/image.h"

namespace saccade {

/// An equirectangular picture of the directions of the world, or a rectangle of it. With W columns
/// around and W / 2 rows from the zenith (+z) down to the nadir, pixel (u, v) of the whole shows
///   longitude pi - 2 pi (u + 1/2) / W,   latitude pi/2 - 2 pi (v + 1/2) / W,
/// the longitude counted from +x towards +y: +x is in the middle of the picture, +y left of it as
/// seen from within, and the seam is at -x. Pixel (x, y) of the rectangle is pixel
///   ((left + x) mod W, top + y) of the whole.
struct Panorama {
  int around = 0;  ///< W [px], even, >= 4
  int left = 0;    ///< first column, in [0, W)
  int top = 0;     ///< first row
  int width = 0;   ///< <= W
  int height = 0;  ///< top + height <= W / 2

  [[nodiscard]] bool operator==(const Panorama&) const = default;

  /// The whole sphere.
  [[nodiscard]] static Panorama sphere(int around) { return {around, 0, 0, around, around / 2}; }

  [[nodiscard]] double pixels_per_radian() const { return around / (2 * std::numbers::pi); }
  /// Whether the last column is the first one's neighbour.
  [[nodiscard]] bool wraps() const { return width == around; }

  /// The unit vector that is shown at (x, y).
  [[nodiscard]] Eigen::Vector3d direction(double x, double y) const;
  /// Where a direction, other than 0, is shown: x within half a turn of the rectangle's middle.
  [[nodiscard]] Eigen::Vector2d pixel(const Eigen::Vector3d& direction) const;
  /// How wide a row is against the equator: the cosine of its latitude, not below half a pixel's.
  [[nodiscard]] double row_width(int y) const;
  /// Steradians of a pixel in row y.
  [[nodiscard]] double solid_angle(int y) const;

  /// Throws InputError(location) unless the rectangle lies within the whole.
  void check(const std::string& location) const;
};

/// What a camera sees, its lens included.
class FieldOfView {
 public:
  explicit FieldOfView(const PinholeCamera& camera);

  /// Whether a direction in the camera's frame falls on the sensor.
  [[nodiscard]] bool sees(const Eigen::Vector3d& direction) const;
  /// Steradians.
  [[nodiscard]] double solid_angle() const;
  /// Angle between what the middles of the left and of the right border see [rad].
  [[nodiscard]] double horizontal_angle() const;

 private:
  PinholeCamera camera_;
  Eigen::Vector2d low_, high_;  ///< around the sensor's undistorted outline [px]
};

/// Those of some orientations that are at least `angle` [rad] from the one kept before.
[[nodiscard]] std::vector<Eigen::Matrix3d> thinned(std::span<const Eigen::Matrix3d> rotations,
                                                   double angle);

/// 1 where one of the cameras with these orientations (in the panorama's world) sees the pixel's
/// centre. In parallel.
[[nodiscard]] ImageU8 seen_by(const FieldOfView& camera,
                              std::span<const Eigen::Matrix3d> world_from_camera,
                              const Panorama& panorama);

/// The part of the sphere that holds what a camera with these orientations sees, and a little
/// around it: all columns where hardly any is left out. Its sides are such that transforms of them
/// are quick. `pixels_per_radian`: at least so many.
[[nodiscard]] Panorama panorama_around(const FieldOfView& camera,
                                       std::span<const Eigen::Matrix3d> world_from_camera,
                                       double pixels_per_radian);

/// Pixels around the sphere for at least `pixels_per_radian`, quick to transform.
[[nodiscard]] int pixels_around(double pixels_per_radian);

}  // namespace saccade
