#pragma once

#include <array>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/image.h"
#include "core/io/images/image_file.h"
#include "core/rigid3.h"

namespace saccade {

/// From a point (x, y) [m] of the plane z = 0 to its undistorted pixel, both homogeneous:
///   z (u, v, 1)^T = K [r1 r2 t] (x, y, 1)^T
/// with r1, r2 the first columns of the rotation and t the translation of camera_from_plane, and z
/// the depth of the point, which the third row of the inverse therefore gives as 1 / z.
[[nodiscard]] Eigen::Matrix3d pixel_from_plane(const PinholeCamera& camera,
                                               const Rigid3& camera_from_plane);

/// A picture with its halvings, for reading it at any size without aliasing. Colours are linear
/// light times alpha, so that transparent texels do not bleed into their neighbours.
class PicturePyramid {
 public:
  /// `picture`: sRGB codes with straight alpha, not empty (contract).
  explicit PicturePyramid(const ImageRgba8& picture);

  [[nodiscard]] int width() const { return levels_.front().width(); }
  [[nodiscard]] int height() const { return levels_.front().height(); }

  /// Red, green, blue (linear, times alpha) and alpha, 0..1, at texel (x, y) of the full picture;
  /// beyond the border its last texel. `footprint`: texels from one sample to the next; bilinear,
  /// between the two levels whose texels are nearest to it.
  [[nodiscard]] Eigen::Array4f sample(double x, double y, double footprint) const;

 private:
  using Level = Image<Eigen::Array4f>;

  [[nodiscard]] Eigen::Array4f sample_level(std::size_t level, double x, double y) const;

  std::vector<Level> levels_;
};

/// A picture at a fixed pose in the world: in the plane z = 0 of its frame, x to the right, y down,
/// its centre at the origin. From behind it appears mirrored.
struct PlanarPicture {
  PicturePyramid texels;
  Rigid3 world_from_picture;
  double width_m = 1;  ///< > 0; the height follows from the picture's shape

  [[nodiscard]] double height_m() const { return width_m * texels.height() / texels.width(); }
  /// Clockwise from the top left, in the world [m].
  [[nodiscard]] std::array<Eigen::Vector3d, 4> corners() const;
};

/// A camera without distortion, drawn with `upscale` x `upscale` screen pixels per sensor pixel.
struct ScreenView {
  PinholeCamera camera;
  Rigid3 world_from_camera;
  int upscale = 1;

  /// Undistorted sensor pixel -> screen pixel; both have their centres at integers.
  [[nodiscard]] Eigen::Vector2d screen_from_pixel(const Eigen::Vector2d& pixel) const {
    return (pixel.array() + 0.5) * upscale - 0.5;
  }
};

/// True where another surface occludes a point, which is given in the camera frame [m].
using OcclusionTest = std::function<bool(const Eigen::Vector3d& point_in_camera)>;

/// Draws the picture over `image` (camera width x upscale by height x upscale): 3 x 3 samples per
/// screen pixel, blended in linear light. Parts behind the camera, pictures seen exactly edge-on,
/// and pixels where `is_occluded` holds (called once per screen pixel; may be empty) are not drawn.
/// `opacity` in [0, 1] multiplies the picture's own. Returns false where no pixel was drawn.
bool draw_planar_picture(const PlanarPicture& picture, const ScreenView& view, double opacity,
                         const OcclusionTest& is_occluded, ImageRgb8& image);

/// Draws the four edges of the picture, as far as they lie in front of the camera.
[[nodiscard]] ImageRgb8 with_outline(ImageRgb8 image, const PlanarPicture& picture,
                                     const ScreenView& view, const Rgb8& colour, int thickness);

}  // namespace saccade
