#include "simulator/scene/intersection/visibility.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "core/check.h"

namespace saccade {
namespace {

/// The poses of an object at the times of some rays, most of which are equal.
class ObjectPoses {
 public:
  explicit ObjectPoses(const MovingObject& object) : object_(object), radius_(object.radius()) {}

  /// Whether the ray intersects the object's bounding sphere within `distance`.
  bool intersects_bounding_sphere(const Ray& ray, double distance) {
    if (ray.time_s != time_s_) move_to(ray.time_s);
    const Eigen::Vector3d to_centre = centre_ - ray.origin;
    const double squared = ray.direction.squaredNorm();
    const double within = radius_ * radius_;
    if (to_centre.cross(ray.direction).squaredNorm() > within * squared) return false;
    if (to_centre.squaredNorm() <= within) return true;
    const double along = to_centre.dot(ray.direction);
    return along > 0 && along - radius_ * std::sqrt(squared) <= distance * squared;
  }

  /// A ray that intersects the sphere, in the object's frame.
  [[nodiscard]] Ray local(const Ray& ray) const { return in_frame(frame_, ray); }

 private:
  void move_to(double time_s) {
    time_s_ = time_s;
    frame_ = object_.frame(time_s);
    centre_ = frame_.rotation * object_.centre() + frame_.position;
  }

  const MovingObject& object_;
  double radius_;
  double time_s_ = std::numeric_limits<double>::quiet_NaN();
  CameraFrame frame_;
  Eigen::Vector3d centre_;
};

/// The rays of a packet that may intersect one object.
struct Candidates {
  std::array<Ray, kRayPacket> rays;  ///< in the object's frame
  std::array<std::size_t, kRayPacket> index{};
  std::array<TriangleId, kRayPacket> triangles{};
  std::array<float, kRayPacket> distances{};
  std::size_t count = 0;
};

void replace_by_nearer(const MovingObject& object, const EmbreeScene& triangles_of_object,
                       std::span<const Ray> rays, std::span<TriangleId> triangles,
                       std::span<float> distances) {
  Candidates some;
  ObjectPoses poses(object);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!poses.intersects_bounding_sphere(rays[i], static_cast<double>(distances[i]))) continue;
    some.rays[some.count] = poses.local(rays[i]);
    some.index[some.count] = i;
    some.triangles[some.count] = triangles[i];
    some.distances[some.count++] = distances[i];
  }
  const std::size_t n = some.count;
  triangles_of_object.nearer({some.rays.data(), n}, {some.triangles.data(), n},
                             {some.distances.data(), n});
  for (std::size_t k = 0; k < n; ++k) {
    triangles[some.index[k]] = some.triangles[k];
    distances[some.index[k]] = some.distances[k];
  }
}

}  // namespace

Visibility::Visibility(std::optional<EmbreeScene> static_triangles,
                       std::vector<MovingObject> objects, std::vector<EmbreeScene> embree_scenes)
    : static_triangles_(std::move(static_triangles)),
      objects_(std::move(objects)),
      embree_scenes_(std::move(embree_scenes)) {
  SACCADE_CHECK(objects_.size() == embree_scenes_.size() &&
                (static_triangles_ || !objects_.empty()));
}

void Visibility::nearest(std::span<const Ray> rays, std::span<TriangleId> triangles) const {
  if (objects_.empty()) return static_triangles_->nearest(rays, triangles);
  SACCADE_CHECK(rays.size() <= kRayPacket && rays.size() == triangles.size());
  std::array<float, kRayPacket> all;
  all.fill(std::numeric_limits<float>::infinity());
  const std::span<float> distances(all.data(), rays.size());
  std::fill(triangles.begin(), triangles.end(), kNothing);
  if (static_triangles_) static_triangles_->nearer(rays, triangles, distances);
  for (std::size_t k = 0; k < objects_.size(); ++k)
    replace_by_nearer(objects_[k], embree_scenes_[k], rays, triangles, distances);
}

void Visibility::find_blocked(std::span<const Ray> rays, std::span<const float> distances,
                              std::span<bool> blocked) const {
  std::fill(blocked.begin(), blocked.end(), false);
  if (static_triangles_) static_triangles_->find_blocked(rays, distances, blocked);
  for (std::size_t k = 0; k < objects_.size(); ++k) {
    ObjectPoses poses(objects_[k]);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (blocked[i] ||
          !poses.intersects_bounding_sphere(rays[i], static_cast<double>(distances[i])))
        continue;
      const Ray local = poses.local(rays[i]);
      embree_scenes_[k].find_blocked({&local, 1}, distances.subspan(i, 1), blocked.subspan(i, 1));
    }
  }
}

}  // namespace saccade
