#include "simulator/scene/visibility/visibility.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "core/check.h"

namespace saccade {
namespace {

/// Where an object is at the times of some rays, most of which are equal.
class Whereabouts {
 public:
  explicit Whereabouts(const MovingObject& object) : object_(object), radius_(object.radius()) {}

  /// Whether the ray passes the object's bounding sphere within `distance`.
  bool meets(const Ray& ray, double distance) {
    if (ray.time_s != time_s_) move_to(ray.time_s);
    const Eigen::Vector3d to_centre = centre_ - ray.origin;
    const double squared = ray.direction.squaredNorm();
    const double within = radius_ * radius_;
    if (to_centre.cross(ray.direction).squaredNorm() > within * squared) return false;
    if (to_centre.squaredNorm() <= within) return true;
    const double along = to_centre.dot(ray.direction);
    return along > 0 && along - radius_ * std::sqrt(squared) <= distance * squared;
  }

  /// A ray that met the sphere, in the object's frame.
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

/// The rays of a packet that may meet one object.
struct Candidates {
  std::array<Ray, kPacket> rays;  ///< in the object's frame
  std::array<std::size_t, kPacket> index{};
  std::array<TriangleId, kPacket> triangles{};
  std::array<float, kPacket> distances{};
  std::size_t count = 0;
};

void replace_by_nearer(const MovingObject& object, const RayCaster& caster,
                       std::span<const Ray> rays, std::span<TriangleId> triangles,
                       std::span<float> distances) {
  Candidates some;
  Whereabouts where(object);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!where.meets(rays[i], static_cast<double>(distances[i]))) continue;
    some.rays[some.count] = where.local(rays[i]);
    some.index[some.count] = i;
    some.triangles[some.count] = triangles[i];
    some.distances[some.count++] = distances[i];
  }
  const std::size_t n = some.count;
  caster.nearer({some.rays.data(), n}, {some.triangles.data(), n}, {some.distances.data(), n});
  for (std::size_t k = 0; k < n; ++k) {
    triangles[some.index[k]] = some.triangles[k];
    distances[some.index[k]] = some.distances[k];
  }
}

}  // namespace

Visibility::Visibility(std::optional<RayCaster> still, std::vector<MovingObject> objects,
                       std::vector<RayCaster> ray_casters)
    : still_(std::move(still)), objects_(std::move(objects)), ray_casters_(std::move(ray_casters)) {
  SACCADE_CHECK(objects_.size() == ray_casters_.size() && (still_ || !objects_.empty()));
}

void Visibility::nearest(std::span<const Ray> rays, std::span<TriangleId> triangles) const {
  if (objects_.empty()) return still_->nearest(rays, triangles);
  SACCADE_CHECK(rays.size() <= kPacket && rays.size() == triangles.size());
  std::array<float, kPacket> all;
  all.fill(std::numeric_limits<float>::infinity());
  const std::span<float> distances(all.data(), rays.size());
  std::fill(triangles.begin(), triangles.end(), kNothing);
  if (still_) still_->nearer(rays, triangles, distances);
  for (std::size_t k = 0; k < objects_.size(); ++k)
    replace_by_nearer(objects_[k], ray_casters_[k], rays, triangles, distances);
}

void Visibility::find_blocked(std::span<const Ray> rays, std::span<const float> distances,
                              std::span<bool> blocked) const {
  std::fill(blocked.begin(), blocked.end(), false);
  if (still_) still_->find_blocked(rays, distances, blocked);
  for (std::size_t k = 0; k < objects_.size(); ++k) {
    Whereabouts where(objects_[k]);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (blocked[i] || !where.meets(rays[i], static_cast<double>(distances[i]))) continue;
      const Ray local = where.local(rays[i]);
      ray_casters_[k].find_blocked({&local, 1}, distances.subspan(i, 1), blocked.subspan(i, 1));
    }
  }
}

}  // namespace saccade
