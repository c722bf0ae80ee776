#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "simulator/scene/scene.h"
#include "simulator/sensor/motion/image_motion.h"

namespace saccade {

/// The camera's twist before everything that it can see at one instant.
class RelativeTwists {
 public:
  /// `scene` must outlive this; `camera`: its state at `t_s`.
  RelativeTwists(const Scene& scene, const SplineState& camera, double t_s);

  /// Before the body of `triangle`; before the static scene for kNothing.
  [[nodiscard]] const Twist& relative_to(TriangleId triangle) const;
  /// Before the point that `ray` sees of a triangle, whose corners may move in its body, with its
  /// velocity at `at_s`: a point moves over the image as a static one does before a camera that
  /// moves against it.
  [[nodiscard]] Twist relative_to(const Ray& ray, TriangleId triangle, double at_s) const;

  /// Greatest speed over the image [px/s] of the point that `ray`, `direction` = (x, y, 1) in the
  /// camera, sees at `depth` of a triangle; as far as its corners move within its body, during
  /// `ahead_s` from the ray's time on.
  [[nodiscard]] double fastest_px_s(const PinholeCamera& camera, const Eigen::Vector3d& direction,
                                    double depth, const Ray& ray, TriangleId triangle,
                                    double ahead_s) const;

 private:
  const Scene& scene_;
  bool is_animated_;
  Eigen::Matrix3d camera_from_world_;
  Twist relative_to_static_;
  std::vector<Twist> relative_to_moving_;  ///< in the order of Scene::moving_objects()
};

/// Where the moving objects of a scene can be seen within a short time, and how fast their points
/// move over the image.
class ObjectMotion {
 public:
  /// From `from_s` to `to_s`, short enough that all motions are nearly even (10 ms).
  ObjectMotion(const Scene& scene, const Spline& world_from_camera, double from_s, double to_s);

  /// Bounds for the points of moving objects that can be within `radius_px` of the direction `ray`
  /// = (x, y, 1) at any time of the span; zero where none can be. `seen`: inverse depths around
  /// there, of all surfaces: an object that is behind all of them counts for nothing, and one that
  /// surrounds the camera is bounded by what is seen. `parallax` is also against a static surface
  /// within `seen`.
  [[nodiscard]] ImageSpeed bound(const PinholeCamera& camera, const Eigen::Vector3d& ray,
                                 double radius_px, const InverseDepthRange& seen) const;

 private:
  /// One object at one instant.
  struct Snapshot {
    Eigen::Matrix3d object_from_camera;
    Eigen::Vector3d camera_in_object;
    Eigen::AlignedBox3d box;  ///< of the object, in its frame
    Twist relative;           ///< of the camera before the object
    Twist camera;             ///< of the camera before the static scene
  };

  /// Range of 1 / z of a snapshot's box within `radius` (on the plane z = 1) of the direction; no
  /// range, low > high, where the box is not met. An infinite `high`: the camera may be inside.
  [[nodiscard]] InverseDepthRange inverse_depths_in_cone(const Snapshot& snapshot,
                                                         const Eigen::Vector3d& ray,
                                                         double radius) const;

  double reach_s_;  ///< around a snapshot's instant for which it stands
  std::vector<Snapshot> snapshots_;
};

}  // namespace saccade
