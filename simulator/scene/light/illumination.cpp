#include "simulator/scene/light/illumination.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/check.h"

namespace saccade {
namespace {

/// The path from a point to a light; one length of `direction` ends at a light with a
/// position. Without the falloff of a cone.
struct LightPath {
  Eigen::Vector3d direction;
  double distance;  ///< [length of direction]
  double irradiance;
};

LightPath path_to(const LightOptions& light, const LitPoint& point) {
  const bool is_near = light.has_position();
  const Eigen::Vector3d direction = is_near ? Eigen::Vector3d(light.position - point.position)
                                            : Eigen::Vector3d(-light.direction);
  const double squared = direction.squaredNorm();
  const double along_normal = point.shading_normal.dot(direction) / std::sqrt(squared);
  double irradiance = light.intensity * along_normal / (is_near ? squared : 1.0);
  if (light.type == LightType::kEmitter)
    irradiance *= std::max(0.0, -light.direction.dot(direction)) / std::sqrt(squared);
  return {direction, is_near ? 1.0 : std::numeric_limits<double>::infinity(), irradiance};
}

/// Unit vector.
Eigen::Vector3d to_light(const LightOptions& light, const Eigen::Vector3d& point) {
  return light.has_position() ? Eigen::Vector3d((light.position - point).normalized())
                              : Eigen::Vector3d(-light.direction);
}

/// The range near a line of a quantity that is not negative.
LightRange near_line(double from, double to, double length_s) {
  LightRange range = range_near_line(from, to, length_s);
  range.low = std::max(0.0, range.low);
  return range;
}

/// What a light throws onto a surface with the normal n is n times this, where that is positive.
/// Without the falloff of a cone.
Eigen::Vector3d flux_of(const LightOptions& light, const Eigen::Vector3d& point) {
  if (!light.has_position()) return -light.intensity * light.direction;
  const Eigen::Vector3d direction = light.position - point;
  const double squared = direction.squaredNorm();
  double flux = light.intensity / (squared * std::sqrt(squared));
  if (light.type == LightType::kEmitter)
    flux *= std::max(0.0, -light.direction.dot(direction)) / std::sqrt(squared);
  return flux * direction;
}

}  // namespace

Illumination::Illumination(double ambient, const std::optional<FlickerOptions>& ambient_flicker,
                           const std::vector<LightOptions>& lights, double shadow_offset,
                           const std::optional<EnvironmentLight>& environment)
    : ambient_(ambient),
      lights_(lights),
      ambient_flicker_(index_of(ambient_flicker)),
      shadow_offset_(shadow_offset),
      environment_(environment) {
  SACCADE_CHECK(lights.size() <= kMaxLights);
  for (LightOptions& light : lights_) light.direction.normalize();
  for (const LightOptions& light : lights_) {
    light_flickers_.push_back(index_of(light.flicker));
    const bool is_spot = light.type == LightType::kSpot;
    cones_.push_back(is_spot ? std::optional<SpotCone>(light) : std::nullopt);
    has_cones_ = has_cones_ || is_spot;
  }
}

std::size_t Illumination::index_of(const std::optional<FlickerOptions>& options) {
  if (!options || options->depth == 0) return kSteady;
  const auto known = std::ranges::find(flickers_, *options, &Flicker::options);
  const auto index = static_cast<std::size_t>(known - flickers_.begin());
  if (known == flickers_.end()) flickers_.emplace_back(*options);
  return index;
}

double Illumination::factor(std::size_t flicker, const LitPoint& point) const {
  return flicker == kSteady ? 1 : flickers_[flicker].mean(point.time_s, point.span_s);
}

LightRange Illumination::factor_range(std::size_t flicker, double from_s, double to_s) const {
  return flicker == kSteady ? LightRange{} : flickers_[flicker].range(from_s, to_s);
}

void Illumination::find_unoccluded_lights(std::span<const LitPoint> points,
                                          const Visibility& blockers, std::span<LightSet> lights,
                                          bool within_cones,
                                          std::span<const KnownLights> known) const {
  std::fill(lights.begin(), lights.end(), LightSet{0});
  std::array<Ray, kRayPacket> rays;
  std::array<float, kRayPacket> distances;
  std::array<std::size_t, kRayPacket> owners;
  std::array<bool, kRayPacket> blocked;
  for (std::size_t index = 0; index < lights_.size(); ++index) {
    const LightSet bit = LightSet{1} << index;
    std::size_t n = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!known.empty() && ((known[i].lit | known[i].hidden) & bit) != 0) {
        lights[i] |= known[i].lit & bit;
        continue;
      }
      const LitPoint& point = points[i];
      const LightPath path = path_to(lights_[index], point);
      // A normal map turns away from a light and back within a texel: that is no edge of a shadow.
      if (!(path.irradiance > 0) && !point.has_normal_map) continue;
      if (point.plane_normal.dot(path.direction) <= 0) continue;
      if (within_cones && !(falloff(index, point) > 0)) continue;
      rays[n] = {point.position + shadow_offset_ * point.plane_normal, path.direction,
                 point.time_s};
      distances[n] = static_cast<float>(path.distance);
      owners[n++] = i;
    }
    if (n == 0) continue;
    blocked.fill(false);
    if (lights_[index].shadows)
      blockers.find_blocked({rays.data(), n}, {distances.data(), n}, {blocked.data(), n});
    for (std::size_t k = 0; k < n; ++k)
      if (!blocked[k]) lights[owners[k]] |= bit;
  }
}

double Illumination::irradiance_of(std::size_t light, const LitPoint& point) const {
  return factor(light_flickers_[light], point) * falloff(light, point) *
         std::max(0.0, path_to(lights_[light], point).irradiance);
}

double Illumination::irradiance(const LitPoint& point, LightSet lights) const {
  double sum = ambient_ * factor(ambient_flicker_, point);
  if (environment_) sum += environment_->radiance(point.shading_normal);
  for (std::size_t index = 0; index < lights_.size(); ++index)
    if ((lights >> index & 1) != 0) sum += irradiance_of(index, point);
  return sum;
}

LightRange Illumination::irradiance_range_of(std::size_t light, const LitPoint& from,
                                             const Eigen::Vector3d& middle, const LitPoint& to,
                                             const VectorRange* normal) const {
  const double length_s = to.time_s - from.time_s;
  const LightOptions& options = lights_[light];
  LightRange steady =
      normal != nullptr
          ? positive_part(dot(*normal, range_near_line(flux_of(options, from.position),
                                                       flux_of(options, to.position), length_s)))
          : near_line(std::max(0.0, path_to(options, from).irradiance),
                      std::max(0.0, path_to(options, to).irradiance), length_s);
  if (const auto& cone = cones_[light])
    steady = steady.times(cone->falloff_range(from.position, middle, to.position, length_s));
  return steady.times(factor_range(light_flickers_[light], from.time_s, to.time_s));
}

LightRange Illumination::irradiance_range(const LitPoint& from, const Eigen::Vector3d& middle,
                                          const LitPoint& to, LightSet lights,
                                          const VectorRange* normal) const {
  const double length_s = to.time_s - from.time_s;
  const LightRange ambient{ambient_, ambient_, 0, 0};
  LightRange sum = ambient.times(factor_range(ambient_flicker_, from.time_s, to.time_s));
  if (environment_)
    sum.add(normal != nullptr ? environment_->range(*normal)
                              : near_line(environment_->radiance(from.shading_normal),
                                          environment_->radiance(to.shading_normal), length_s));
  for (std::size_t index = 0; index < lights_.size(); ++index)
    if ((lights >> index & 1) != 0) sum.add(irradiance_range_of(index, from, middle, to, normal));
  return sum;
}

double Illumination::mirrored(const GlossyPoint& seen, const Gloss& gloss, LightSet lights) const {
  const LitPoint& point = seen.point;
  const Eigen::Vector3d to_eye = (seen.eye - point.position).normalized();
  double sum = 0;
  for (std::size_t index = 0; index < lights_.size(); ++index) {
    if ((lights >> index & 1) == 0) continue;
    const Eigen::Vector3d half = (to_eye + to_light(lights_[index], point.position)).normalized();
    sum += gloss.factor(std::min(point.shading_normal.cross(half).squaredNorm(), 1.0)) *
           irradiance_of(index, point);
  }
  return sum;
}

LightRange Illumination::mirrored_range(const GlossyPoint& from, const Eigen::Vector3d& middle,
                                        const GlossyPoint& to, const Gloss& gloss, LightSet lights,
                                        const VectorRange* normal) const {
  const double length_s = to.point.time_s - from.point.time_s;
  const auto to_eye = [](const GlossyPoint& seen) {
    return Eigen::Vector3d((seen.eye - seen.point.position).normalized());
  };
  const VectorRange eye = range_near_line(to_eye(from), to_eye(to), length_s);
  const VectorRange normals =
      normal != nullptr
          ? *normal
          : range_near_line(from.point.shading_normal, to.point.shading_normal, length_s);
  LightRange total{0, 0, 0, 0};
  for (std::size_t index = 0; index < lights_.size(); ++index) {
    if ((lights >> index & 1) == 0) continue;
    const VectorRange light =
        range_near_line(to_light(lights_[index], from.point.position),
                        to_light(lights_[index], to.point.position), length_s);
    const LightRange sine_squared = squared_norm(cross(normals, unit(sum(eye, light))));
    total.add(gloss.factor_range(sine_squared)
                  .times(irradiance_range_of(index, from.point, middle, to.point, normal)));
  }
  return total;
}

}  // namespace saccade
