#include "simulator/sensor/motion/object_motion.h"

#include <algorithm>
#include <limits>

#include "simulator/scene/moving_object.h"

namespace saccade {
namespace {

constexpr int kInstants = 3;
/// A pixel of a distorted image may be this many pixels of the ideal one.
constexpr double kLensMargin = 2;
/// Instants at which the speed of a deformation is asked for: animations have keys at 24 to 60 Hz,
/// and slices are 20 ms long at most.
constexpr int kLooksAhead = 5;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Keeps of [low, high] the z with slope * z >= least.
void clip(double slope, double least, double& low, double& high) {
  if (slope > 0) {
    low = std::max(low, least / slope);
  } else if (slope < 0) {
    high = std::min(high, least / slope);
  } else if (least > 0) {
    high = -kInfinity;
  }
}

Eigen::Vector2d image_velocity(const PinholeCamera& camera, const Eigen::Vector3d& ray,
                               const Twist& twist, double inverse_depth) {
  return -interaction_matrix(camera, ray, 1 / inverse_depth) * twist;
}

/// Largest speed of a point of one range against a point of the other.
double speed_between(const PinholeCamera& camera, const Eigen::Vector3d& ray, const Twist& twist_a,
                     const InverseDepthRange& range_a, const Twist& twist_b,
                     const InverseDepthRange& range_b) {
  double largest = 0;
  for (const double a : {range_a.low, range_a.high})
    for (const double b : {range_b.low, range_b.high})
      largest = std::max(largest, (image_velocity(camera, ray, twist_a, a) -
                                   image_velocity(camera, ray, twist_b, b))
                                      .norm());
  return largest;
}

}  // namespace

RelativeTwists::RelativeTwists(const Scene& scene, const SplineState& camera, double t_s)
    : scene_(scene),
      is_animated_(scene.is_animated()),
      camera_from_world_(camera.world_from_body.rotation_matrix().transpose()),
      relative_to_static_(camera_twist(camera)) {
  for (const MovingObject& object : scene.moving_objects())
    relative_to_moving_.push_back(relative_twist(camera, object.state(t_s)));
}

const Twist& RelativeTwists::relative_to(TriangleId triangle) const {
  const MovingObject* object = scene_.moving_object(triangle);
  if (object == nullptr) return relative_to_static_;
  return relative_to_moving_[static_cast<std::size_t>(object - scene_.moving_objects().data())];
}

Twist RelativeTwists::relative_to(const Ray& ray, TriangleId triangle, double at_s) const {
  Twist twist = relative_to(triangle);
  if (is_animated_)
    twist.head<3>() -= camera_from_world_ * scene_.deformation_velocity(ray, triangle, at_s);
  return twist;
}

double RelativeTwists::fastest_px_s(const PinholeCamera& camera, const Eigen::Vector3d& direction,
                                    double depth, const Ray& ray, TriangleId triangle,
                                    double ahead_s) const {
  if (!is_animated_) return point_motion(camera, direction, depth, relative_to(triangle)).norm();
  double fastest = 0;
  for (int k = 0; k < kLooksAhead; ++k)
    fastest = std::max(
        fastest,
        point_motion(camera, direction, depth,
                     relative_to(ray, triangle, ray.time_s + ahead_s * k / (kLooksAhead - 1)))
            .norm());
  return fastest;
}

ObjectMotion::ObjectMotion(const Scene& scene, const Spline& world_from_camera, double from_s,
                           double to_s)
    : reach_s_((to_s - from_s) / (kInstants - 1)) {
  if (scene.moving_objects().empty()) return;
  for (int k = 0; k < kInstants; ++k) {
    const double t_s = from_s + k * reach_s_;
    const SplineState camera = world_from_camera.state(t_s);
    for (const MovingObject& object : scene.moving_objects()) {
      const SplineState state = object.state(t_s);
      const Rigid3 object_from_camera = state.world_from_body.inverse() * camera.world_from_body;
      snapshots_.push_back({object_from_camera.rotation_matrix(), object_from_camera.translation(),
                            object.box(), relative_twist(camera, state), camera_twist(camera)});
    }
  }
}

InverseDepthRange ObjectMotion::inverse_depths_in_cone(const Snapshot& snapshot,
                                                       const Eigen::Vector3d& ray,
                                                       double radius) const {
  // The point at z on the ray, in the object's frame, is start + z * slope, up to the cone's
  // width and the motion until the next snapshot, both affine in z: margin + z * spread.
  const Eigen::Vector3d slope = snapshot.object_from_camera * ray;
  const double margin = reach_s_ * snapshot.relative.head<3>().norm();
  const double spread = radius + reach_s_ * snapshot.relative.tail<3>().norm() * ray.norm();
  double low = 0;
  double high = kInfinity;
  for (int axis = 0; axis < 3; ++axis) {
    const double start = snapshot.camera_in_object[axis];
    clip(slope[axis] + spread, snapshot.box.min()[axis] - margin - start, low, high);
    clip(spread - slope[axis], start - margin - snapshot.box.max()[axis], low, high);
  }
  if (low > high) return {kInfinity, 0};
  return {1 / high, 1 / low};
}

ImageSpeed ObjectMotion::bound(const PinholeCamera& camera, const Eigen::Vector3d& ray,
                               double radius_px, const InverseDepthRange& seen) const {
  const double radius = kLensMargin * radius_px / std::min(camera.fx, camera.fy);
  ImageSpeed largest;
  for (const Snapshot& snapshot : snapshots_) {
    InverseDepthRange range = inverse_depths_in_cone(snapshot, ray, radius);
    if (range.low > range.high || range.high < seen.low) continue;
    if (range.high == kInfinity) range.high = std::max(seen.high, range.low);
    const ImageSpeed speed = image_speed_bound(camera, ray, radius_px, snapshot.relative, range);
    largest.fastest = std::max(largest.fastest, speed.fastest);
    largest.parallax =
        std::max({largest.parallax, speed.parallax,
                  speed_between(camera, ray, snapshot.relative, range, snapshot.camera, seen)});
  }
  return largest;
}

}  // namespace saccade
