#pragma once

#include <functional>
#include <optional>

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
  float x = 0, y = 0;       ///< [px of the reference view], undistorted, also outside of it
  float inverse_depth = 0;  ///< 1 / z in the reference view [1/m]
};

/// Finds the place in the reference view that a sensor pixel sees (6.3), pi(T pi^-1(u, d_u)), with
/// the surfaces as they are seen from near the camera's pose: they are drawn anew whenever the
/// image has moved by `redraw_px`. Nothing is found within `step_margin_px` (in x and y) of a step
/// of depth: where an occluder ends is known to a pixel only, and what such a pixel sees is either.
class PlaceFinder {
 public:
  PlaceFinder(const PinholeCamera& camera, const DepthScene& scene,
              const Rigid3& world_from_reference, double redraw_px, int step_margin_px = 0);

  /// Draws the surfaces anew where the camera has moved too far from where they were drawn.
  void prepare(const CameraPose& reference_from_camera);

  /// nullopt where no depth is known. After prepare() for a pose nearby.
  [[nodiscard]] std::optional<Place> find(int x, int y,
                                          const CameraPose& reference_from_camera) const;

  /// How often the surfaces were drawn.
  [[nodiscard]] int draws() const { return draws_; }

  /// How far what the camera sees was from there at an earlier pose: the furthest of a few points
  /// [px]; infinity where one was behind it. After prepare().
  [[nodiscard]] double moved_px(const CameraPose& reference_from_camera,
                                const CameraPose& earlier_from_reference) const;

 private:
  void mark_steps();
  /// 1 / z where the view sees something, bilinear on one surface, else of the nearest known pixel.
  [[nodiscard]] float look_up(float x, float y) const;

  PinholeCamera camera_;  ///< without the lens
  UndistortionTable undistorted_;
  const DepthScene& scene_;
  Rigid3 world_from_reference_;
  double redraw_px_;
  int step_margin_px_;
  float fx_, fy_, cx_, cy_;
  ImageF inverse_depth_;  ///< of the view
  ImageU8 is_near_step_;  ///< of the view
  CameraPose view_from_reference_;
  int draws_ = 0;
};

[[nodiscard]] CameraPose inverse_of(const CameraPose& pose);

}  // namespace saccade
