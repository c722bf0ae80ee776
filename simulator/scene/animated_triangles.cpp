#include <algorithm>
#include <cmath>
#include <optional>

#include "simulator/scene/scene.h"
#include "simulator/scene/scene_state.h"

// What of a scene concerns triangles whose corners move.

namespace saccade {
namespace {

/// A form of the weights of the second and the third corner as one of the point.
AffineForm of_point(const AffineForm& of_weights, const TriangleInterior& interior) {
  const double second = of_weights.gradient.x();
  const double third = of_weights.gradient.y();
  return {second * interior.second.gradient + third * interior.third.gradient,
          of_weights.offset + second * interior.second.offset + third * interior.third.offset};
}

}  // namespace

TriangleInstant Scene::State::instant(TriangleId triangle, double t_s) const {
  const TriangleSurface& stored = surfaces[triangle];
  const VertexAnimation& animation = *visibility->objects()[stored.body].animation();
  const CornerIndices& corners = animated[stored.body].corners(triangle);
  const VertexAnimation::Moment moment = animation.at(t_s);
  const Eigen::Vector3d a = animation.vertex(moment, corners[0]);
  const Eigen::Vector3d to_b = animation.vertex(moment, corners[1]) - a;
  const Eigen::Vector3d to_c = animation.vertex(moment, corners[2]) - a;
  const Eigen::Vector3d normal = to_b.cross(to_c);
  const double squared = normal.squaredNorm();
  const auto form = [&a](const Eigen::Vector3d& gradient) {
    return AffineForm{gradient, -gradient.dot(a)};
  };
  TriangleInstant now{stored,
                      {form(to_c.cross(normal) / squared), form(normal.cross(to_b) / squared)}};
  now.surface.plane = form(normal / std::sqrt(squared));
  now.surface.x = of_point(stored.x, now.interior);
  now.surface.y = of_point(stored.y, now.interior);
  return now;
}

ShadingNormals Scene::State::normals_at(TriangleId triangle, double t_s,
                                        const AffineForm& plane) const {
  const std::uint32_t body = surfaces[triangle].body;
  const VertexAnimation& animation = *visibility->objects()[body].animation();
  const VertexAnimation::Moment moment = animation.at(t_s);
  ShadingNormals result;
  for (std::size_t k = 0; k < result.size(); ++k) {
    const Eigen::Vector3d stated = animation.normal(moment, animated[body].corners(triangle)[k]);
    // As TriangleSetup has it: many files wind their faces against their normals.
    const double side = stated.dot(plane.gradient) < 0 ? -1.0 : 1.0;
    result[k] = (stated.norm() > 0 ? Eigen::Vector3d(side * stated.normalized()) : plane.gradient)
                    .cast<float>();
  }
  return result;
}

Eigen::Vector3d Scene::State::corner_weights(const Ray& ray, TriangleId triangle) const {
  return with_triangle(
      triangle, ray,
      [](const Ray& local, const TriangleSurface& surface, const TriangleInterior& interior) {
        const Eigen::Vector3d point =
            local.origin + distance_to(surface.plane, local) * local.direction;
        const double second = interior.second.at(point);
        const double third = interior.third.at(point);
        return Eigen::Vector3d(1 - second - third, second, third);
      });
}

bool Scene::is_animated() const {
  return std::ranges::any_of(
      moving_objects(), [](const MovingObject& object) { return object.animation() != nullptr; });
}

Eigen::Vector3d Scene::carried_point(const Ray& ray, TriangleId triangle, double to_s) const {
  const double distance = sample_surface(ray, triangle).distance;
  const Eigen::Vector3d point = ray.origin + distance * ray.direction;
  const MovingObject* const object = moving_object(triangle);
  if (object == nullptr) return point;
  const VertexAnimation* const animation = object->animation();
  if (animation == nullptr)
    return object->pose(to_s) * (object->pose(ray.time_s).inverse() * point);
  const Eigen::Vector3d weights = state_->corner_weights(ray, triangle);
  const CornerIndices& corners =
      state_->animated[state_->surfaces[triangle].body].corners(triangle);
  const VertexAnimation::Moment moment = animation->at(to_s);
  Eigen::Vector3d there = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k)
    there += weights[k] * animation->vertex(moment, corners[static_cast<std::size_t>(k)]);
  return object->pose(to_s) * there;
}

Eigen::Vector3d Scene::deformation_velocity(const Ray& ray, TriangleId triangle,
                                            double at_s) const {
  if (triangle == kNothing) return Eigen::Vector3d::Zero();
  const VertexAnimation* const animation = state_->animation_of(triangle);
  if (animation == nullptr) return Eigen::Vector3d::Zero();
  const VertexAnimation::Moment moment = animation->at(at_s);
  if (moment.per_s == 0) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d weights = state_->corner_weights(ray, triangle);
  const std::uint32_t body = state_->surfaces[triangle].body;
  const CornerIndices& corners = state_->animated[body].corners(triangle);
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k)
    velocity += weights[k] * animation->velocity(moment, corners[static_cast<std::size_t>(k)]);
  return moving_objects()[body].frame(at_s).rotation * velocity;
}

std::optional<double> Scene::first_kink_s(TriangleId triangle, double from_s, double to_s) const {
  if (triangle == kNothing) return std::nullopt;
  const VertexAnimation* const animation = state_->animation_of(triangle);
  return animation == nullptr ? std::nullopt : animation->first_kink_s(from_s, to_s);
}

}  // namespace saccade
