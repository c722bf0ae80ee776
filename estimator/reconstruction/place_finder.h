#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/image.h"
#include "core/rigid3.h"
#include "estimator/reconstruction/pose_table.h"

namespace saccade {

/// The known surfaces, as any camera sees them.
struct DepthScene {
  /// Writes 1 / z [1/m], 0 = unknown, of a camera without lens distortion.
  std::function<void(const Rigid3& camera_from_world, const PinholeCamera&, ImageF& inverse_depth)>
      draw;
  float typical_depth_m = 1;
};

/// Where a pixel looks, in the reference view.
struct Place {
  float x = 0, y = 0;       ///< [px of the reference view], undistorted, within it
  float inverse_depth = 0;  ///< 1 / z in the reference view [1/m]
};

/// Where all pixels of the sensor look at one time, in row-major order.
struct PlaceField {
  std::vector<float> x, y;           ///< [px of the reference view]
  std::vector<float> inverse_depth;  ///< 1 / z in the reference view [1/m]; 0: no place is seen

  void resize(std::size_t pixels) {
    x.resize(pixels);
    y.resize(pixels);
    inverse_depth.resize(pixels);
  }
};

/// How far what a camera sees moves in its image [px], the furthest of a few points.
struct ViewShift {
  double length = 0;  ///< from the first pose to the last
  double bend = 0;    ///< at the middle pose, from where it would be half way
};

struct PlaceOptions {
  double redraw_px = 8;  ///< image motion after which the surfaces are drawn anew
  double parallax_px =
      1;  ///< ... or after which two of them have shifted so far at a step of depth
  double same_surface = 0.05;  ///< relative difference of depth up to which a place is visible
  int step_margin_px = 0;      ///< nothing is found this near to a step of depth, in x and y
};

/// Finds the place in the reference view that a sensor pixel sees (6.3), pi(T pi^-1(u, d_u)): the
/// pixel's ray meets the plane of the surface around the place, n . p = 1, exactly. Which place it
/// is, and whether something hides it, is read from the surfaces as they are seen from near the
/// camera's pose; they are drawn seldom. Nothing is found near a step of depth: where an occluder
/// ends is known to a pixel only, and what such a pixel sees is either.
class PlaceFinder {
 public:
  /// `reference_inverse_depth`: what the reference view sees [1/m], 0 = unknown.
  PlaceFinder(const PinholeCamera& camera, const DepthScene& scene,
              const Rigid3& world_from_reference, const ImageF& reference_inverse_depth,
              const PlaceOptions& options);

  /// Draws the surfaces anew where the camera has moved too far from where they were drawn.
  void prepare(const CameraPose& reference_from_camera);

  /// nullopt where no depth is known or the place is not seen by both. After prepare() for a pose
  /// nearby. `earlier`: where the pixel looked a little earlier, within the reference view: a first
  /// guess that costs nothing.
  [[nodiscard]] std::optional<Place> find(int x, int y, const CameraPose& reference_from_camera,
                                          const Eigen::Vector2f* earlier = nullptr) const;

  /// The same for all pixels, into `places`. `earlier`: their places a little earlier, which they
  /// are followed from, many at a time; those that had none are looked for in turns.
  void follow(const CameraPose& reference_from_camera, const PlaceField& earlier,
              PlaceField& places);

  /// How often the surfaces were drawn.
  [[nodiscard]] int draws() const { return draws_; }

  /// How far what the camera sees was from there at an earlier pose: the furthest of a few points
  /// [px]; infinity where one was behind it. After prepare().
  [[nodiscard]] double moved_px(const CameraPose& reference_from_camera,
                                const CameraPose& earlier_from_reference) const;

  /// ... and along a path of three poses. Infinite where a point gets behind the camera.
  [[nodiscard]] ViewShift motion(const CameraPose& reference_from_first,
                                 const CameraPose& middle_from_reference,
                                 const CameraPose& last_from_reference) const;

 private:
  /// The plane n . p = 1 of the surface at a pixel of the reference view.
  struct Plane {
    Eigen::Vector3f normal;
    float inverse_depth;  ///< at the pixel; 0: unknown
  };
  /// A pixel of the drawn view where two surfaces meet.
  struct Step {
    Eigen::Vector3f ray;
    float near, far;  ///< their depths [m]
  };

  void set_planes(const ImageF& inverse_depth);
  /// Points of what the camera sees near a pose, a few all over its image.
  [[nodiscard]] std::vector<Eigen::Vector3f> samples(const CameraPose& reference_from_camera) const;
  void follow_chunk(std::size_t first, std::size_t count, const CameraPose& reference_from_camera,
                    const PlaceField& earlier, PlaceField& places) const;
  void mark_steps();
  /// How far surfaces have shifted against each other since the view was drawn [px].
  [[nodiscard]] double parallax_px(const CameraPose& reference_from_camera) const;
  /// The place of the drawn view's depth along a ray, from + z direction.
  [[nodiscard]] bool guess(const Eigen::Vector3f& ray, const Eigen::Vector3f& direction,
                           const Eigen::Vector3f& from, Place& place) const;
  /// Where the ray meets the surface near a first guess; false if it does not.
  [[nodiscard]] bool meet_surface(const Eigen::Vector3f& direction, const Eigen::Vector3f& from,
                                  Place& place, Eigen::Vector3f& point) const;
  /// Whether nothing hides a point of the reference view, far from steps of depth.
  [[nodiscard]] bool is_seen(const Eigen::Vector3f& point) const;

  /// Index of the drawn view's pixel nearest to where it sees a point; -1: outside.
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
  /// Whether a point in front of the reference view lies within it, and where.
  [[nodiscard]] bool project(const Eigen::Vector3f& point, Place& place) const {
    place.inverse_depth = 1 / point.z();
    place.x = fx_ * point.x() * place.inverse_depth + cx_;
    place.y = fy_ * point.y() * place.inverse_depth + cy_;
    return is_inside(planes_, place.x, place.y);
  }
  [[nodiscard]] const Plane& plane_at(const Place& place) const {
    return planes_(static_cast<int>(place.x + 0.5F), static_cast<int>(place.y + 0.5F));
  }
  [[nodiscard]] bool is_same(float seen, float expected) const {
    return std::abs(seen - expected) <= same_surface_ * expected;
  }

  PinholeCamera camera_;       ///< without the lens
  PinholeCamera view_camera_;  ///< ... and larger on all sides by what it may move
  const DepthScene& scene_;
  Rigid3 world_from_reference_;
  PlaceOptions options_;
  float fx_, fy_, cx_, cy_;
  float same_surface_;
  float margin_;                 ///< of the drawn view around the camera's [px]
  Image<Eigen::Vector3f> rays_;  ///< of the sensor's pixels, z = 1
  ImageF ray_x_, ray_y_;         ///< the same
  Image<Plane> planes_;          ///< of the reference view
  ImageF inverse_depth_;         ///< of the drawn view
  ImageF open_inverse_depth_;    ///< the same, 0 near steps of depth
  std::vector<Step> steps_;      ///< a few of those pixels
  CameraPose view_from_reference_;
  int draws_ = 0;
  int follows_ = 0;
};

[[nodiscard]] CameraPose inverse_of(const CameraPose& pose);

}  // namespace saccade
