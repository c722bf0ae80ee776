#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/image.h"
#include "core/rigid3.h"
#include "estimator/run/pose_table.h"

namespace saccade {

/// The known surfaces, which any camera can be rendered from.
struct DepthScene {
  /// Writes 1 / z [1/m], 0 = unknown, of a camera without lens distortion.
  std::function<void(const Rigid3& camera_from_world, const PinholeCamera&, ImageF& inverse_depth)>
      draw;
  float typical_depth_m = 1;
};

/// The point of the reference view that a sensor pixel observes.
struct Reprojection {
  float x = 0, y = 0;       ///< [px of the reference view], undistorted, within it
  float inverse_depth = 0;  ///< 1 / z in the reference view [1/m]
};

/// The reprojections of all pixels of the sensor at one time, in row-major order.
struct ReprojectionField {
  std::vector<float> x, y;           ///< [px of the reference view]
  std::vector<float> inverse_depth;  ///< 1 / z in the reference view [1/m]; 0: no reprojection

  void resize(std::size_t pixels) {
    x.resize(pixels);
    y.resize(pixels);
    inverse_depth.resize(pixels);
  }
};

/// Image motion [px] of what a camera sees, the maximum over a few points.
struct ImagePath {
  double length = 0;  ///< from the first pose to the last
  double bend = 0;    ///< deviation from a straight line at the middle pose
};

struct ReprojectionOptions {
  /// Image motion after which the surfaces are rendered anew for the depth test.
  double redraw_motion_px = 8;
  /// Parallax at a depth discontinuity after which they are rendered anew, too.
  double redraw_parallax_px = 1;
  int discontinuity_margin_px = 0;
};

/// The pixel nearest to a coordinate >= 0, by a cast, which loops vectorise.
[[nodiscard]] inline int nearest_pixel(float px) {
  const float shifted = px + 0.5F;
  return static_cast<int>(shifted);
}

/// Rows of a sensor's pixels, [begin, end).
struct PixelRows {
  int begin = 0, end = 0;
};

/// The surfaces as a camera sees them, for the depth test of poses near its own.
struct RenderedSurfaces {
  /// A pixel at a depth discontinuity.
  struct Discontinuity {
    Eigen::Vector3f ray;
    float near, far;  ///< their depths [m]
  };

  ImageF inverse_depth;                        ///< [1/m], 0: nothing is known
  ImageF open_inverse_depth;                   ///< the same, 0 near depth discontinuities
  std::vector<Discontinuity> discontinuities;  ///< a sample of those pixels
  CameraPose camera_from_reference;
};

/// Relative difference of depth up to which two depths are the same surface (depth test).
inline constexpr double kSameSurfaceRatio = 0.05;

/// Reprojects sensor pixels into the reference view, pi(T pi^-1(u, d_u)) of (6.3): the pixel's ray is
/// intersected with the plane of the surface there, n . p = 1, exactly. Which surface that is, and
/// whether another one occludes it, is read from an inverse depth map rendered near the camera's
/// pose, which is renewed seldom. Pixels near a depth discontinuity have no reprojection: the
/// position of an occluding contour is known to a pixel only.
class Reprojector {
 public:
  /// `reference_inverse_depth`: of the reference view [1/m], 0 = unknown.
  Reprojector(const PinholeCamera& camera, const DepthScene& scene,
              const Rigid3& world_from_reference, const ImageF& reference_inverse_depth,
              const ReprojectionOptions& options);

  /// The surfaces near a pose: those rendered last, or anew if the camera has moved too far since.
  const std::shared_ptr<const RenderedSurfaces>& prepare(const CameraPose& reference_from_camera);

  /// nullopt where no depth is known or the point is not visible in both views. `surfaces`: of a pose nearby.
  /// `earlier`: the pixel's reprojection a little earlier, within the reference view, as a first guess.
  [[nodiscard]] std::optional<Reprojection> find(int x, int y, const RenderedSurfaces& surfaces,
                                                 const CameraPose& reference_from_camera,
                                                 const Eigen::Vector2f* earlier = nullptr) const;

  /// The same for all pixels of some rows, into `reprojections`, from their reprojections a little
  /// earlier, vectorised. Of pixels that had none, a fraction is searched in each `pass`, which counts
  /// from 0: all in the first.
  void follow(PixelRows rows, int pass, const RenderedSurfaces& surfaces,
              const CameraPose& reference_from_camera, const ReprojectionField& earlier,
              ReprojectionField& reprojections) const;

  /// Number of renderings.
  [[nodiscard]] int draws() const { return draws_; }

  /// Image motion since an earlier pose [px], of points of the surfaces that prepare() returned last; infinity where
  /// one was behind the camera. For the thread that calls prepare(), as motion().
  [[nodiscard]] double moved_px(const CameraPose& reference_from_camera,
                                const CameraPose& earlier_from_reference) const;

  /// Image motion along three poses; infinity where a point gets behind the camera.
  [[nodiscard]] ImagePath motion(const CameraPose& reference_from_first,
                                 const CameraPose& middle_from_reference,
                                 const CameraPose& last_from_reference) const;

 private:
  /// The plane n . p = 1 of the surface at a pixel of the reference view.
  struct Plane {
    Eigen::Vector3f normal;
    float inverse_depth;  ///< at the pixel; 0: unknown
  };
  void set_planes(const ImageF& inverse_depth);
  /// A few visible points, evenly distributed over the camera's image.
  [[nodiscard]] std::vector<Eigen::Vector3f> samples(const CameraPose& reference_from_camera) const;
  void follow_chunk(std::size_t first, std::size_t count, const RenderedSurfaces& surfaces,
                    const CameraPose& reference_from_camera, const ReprojectionField& earlier,
                    ReprojectionField& reprojections) const;
  void mark_discontinuities(RenderedSurfaces& surfaces) const;
  /// Largest parallax at a depth discontinuity since the last rendering [px].
  [[nodiscard]] double parallax_px(const CameraPose& reference_from_camera) const;
  /// First guess along the ray from + z direction, from the rendered depth.
  [[nodiscard]] bool guess(const Eigen::Vector3f& ray, const RenderedSurfaces& surfaces,
                           const Eigen::Vector3f& direction, const Eigen::Vector3f& from,
                           Reprojection& reprojection) const;
  /// Intersects the ray with the surface near a first guess; false without an intersection.
  [[nodiscard]] bool intersect_surface(const Eigen::Vector3f& direction,
                                       const Eigen::Vector3f& from, Reprojection& reprojection,
                                       Eigen::Vector3f& point) const;
  /// Depth test of a point of the reference view; false near depth discontinuities.
  [[nodiscard]] bool is_visible(const RenderedSurfaces& surfaces,
                                const Eigen::Vector3f& point) const;

  /// Index of the rendered view's pixel nearest to the projection of a point; -1: outside.
  [[nodiscard]] int view_index(const Eigen::Vector3f& in_view) const {
    if (!(in_view.z() > 0)) return -1;
    const float scale = 1 / in_view.z();
    const float x = fx_ * in_view.x() * scale + cx_ + margin_ + 0.5F;
    const float y = fy_ * in_view.y() * scale + cy_ + margin_ + 0.5F;
    if (!(x >= 0 && y >= 0 && x < static_cast<float>(view_camera_.width) &&
          y < static_cast<float>(view_camera_.height)))
      return -1;
    return static_cast<int>(y) * view_camera_.width + static_cast<int>(x);
  }
  /// Projects a point in front of the reference view; false outside the view.
  [[nodiscard]] bool project(const Eigen::Vector3f& point, Reprojection& reprojection) const {
    reprojection.inverse_depth = 1 / point.z();
    reprojection.x = fx_ * point.x() * reprojection.inverse_depth + cx_;
    reprojection.y = fy_ * point.y() * reprojection.inverse_depth + cy_;
    return is_inside(planes_, reprojection.x, reprojection.y);
  }
  [[nodiscard]] const Plane& plane_at(const Reprojection& reprojection) const {
    return planes_(nearest_pixel(reprojection.x), nearest_pixel(reprojection.y));
  }
  [[nodiscard]] bool is_same_surface(float found, float expected) const {
    return std::abs(found - expected) <= static_cast<float>(kSameSurfaceRatio) * expected;
  }

  PinholeCamera camera_;  ///< without the lens
  PinholeCamera
      view_camera_;  ///< ... and larger on all sides by the motion until the next rendering
  const DepthScene& scene_;
  Rigid3 world_from_reference_;
  ReprojectionOptions options_;
  float fx_, fy_, cx_, cy_;
  float margin_;                 ///< of the rendered view around the camera's [px]
  Image<Eigen::Vector3f> rays_;  ///< of the sensor's pixels, z = 1
  ImageF ray_x_, ray_y_;         ///< the same
  Image<Plane> planes_;          ///< of the reference view
  std::shared_ptr<const RenderedSurfaces> surfaces_;  ///< rendered last
  int draws_ = 0;
};

[[nodiscard]] CameraPose inverse_of(const CameraPose& pose);

}  // namespace saccade
