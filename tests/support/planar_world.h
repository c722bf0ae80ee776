#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/event.h"
#include "core/image.h"
#include "core/rigid3.h"
#include "core/trajectory.h"

namespace saccade::testing {

/// A textured rectangle: corner + s * edge_u + t * edge_v, s and t in [0, 1]; the edges are
/// orthogonal.
struct TexturedPlane {
  Eigen::Vector3d corner;  ///< [m]
  Eigen::Vector3d edge_u;  ///< [m]
  Eigen::Vector3d edge_v;  ///< [m]
  ImageF log_intensity;    ///< bilinear in log intensity, first texel at the corner
};

using Motion = std::function<Rigid3(double t_s)>;  ///< world_from_camera

/// Rectangles in front of a uniform background, seen by a point-sampling camera: the smallest world
/// from which a tracker must recover its poses.
class PlanarWorld {
 public:
  PlanarWorld(PinholeCamera camera, std::vector<TexturedPlane> planes);

  [[nodiscard]] const PinholeCamera& camera() const { return camera_; }
  /// ln(intensity) of every pixel.
  [[nodiscard]] ImageF log_intensity(const Rigid3& world_from_camera) const;
  /// z depth [m], 0 = background.
  [[nodiscard]] ImageF depth(const Rigid3& world_from_camera) const;
  /// Events of an ideal sensor over [start_s, end_s]: the signal is sampled every `step_s` and
  /// linear in between; in EventOrder.
  [[nodiscard]] Events simulate(const Motion& world_from_camera, double start_s, double end_s,
                                double step_s, double contrast) const;

 private:
  struct View {
    ImageF log_intensity;
    ImageF depth;
  };
  [[nodiscard]] View view(const Rigid3& world_from_camera) const;

  PinholeCamera camera_;
  std::vector<TexturedPlane> planes_;
};

/// Random patches of several sizes and contrasts, slightly blurred; ln(intensity) in about [-3, 0].
[[nodiscard]] ImageF patch_texture(int width, int height, std::uint64_t seed);

/// A corner of two walls 2..3 m away with a smaller plane in front of it, at any sensor size;
/// focal length = 0.83 width.
[[nodiscard]] PlanarWorld corner_world(int width, int height);

/// One wall across the optical axis, 4.8 m x 3.6 m in patches of `columns` x `rows` texels, before a
/// camera of width x height pixels.
[[nodiscard]] PlanarWorld wall_world(int width, int height, double focal_px, double depth_m,
                                     int columns, int rows);

/// What corner_world() shows from the origin is typically this far away [m].
constexpr double kCornerDepth_m = 2.2;

/// Mostly sideways, 12 px of parallax in a tenth of a second at 160 x 120 px, with a turn that
/// derotation must take out; for corner_world().
[[nodiscard]] Rigid3 corner_glide(double t_s);

/// corner_glide() up to `true_until_s`, from where on the path drifts away: at `end_s` by 1 % of the
/// depth and 7 mrad.
[[nodiscard]] Rigid3 drifting_glide(double t_s, double true_until_s, double end_s);

/// Smooth six-degree motion of decimetres and a few degrees within a second, for corner_world().
[[nodiscard]] Rigid3 corner_motion(double t_s);

/// A pose every millisecond from 0 to `end_s`.
[[nodiscard]] Trajectory trajectory_of(const Motion& world_from_camera, double end_s);

}  // namespace saccade::testing
