#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "simulator/scene/intersection/visibility.h"
#include "simulator/scene/light/environment_light.h"
#include "simulator/scene/light/flicker.h"
#include "simulator/scene/light/gloss.h"
#include "simulator/scene/light/light_options.h"
#include "simulator/scene/light/spot_cone.h"
#include "simulator/scene/light/vector_range.h"

namespace saccade {

/// A point on a surface in the world, with unit normals on the side that is seen.
struct LitPoint {
  Eigen::Vector3d position;
  Eigen::Vector3d plane_normal;
  Eigen::Vector3d shading_normal;
  double time_s;                ///< at which it is seen
  double span_s;                ///< around it, over which flickering light is averaged
  bool has_normal_map = false;  ///< which the shading normal follows
};

/// A point of a glossy surface, as an eye sees it.
struct GlossyPoint {
  LitPoint point;
  Eigen::Vector3d eye;
};

/// What falls onto a surface: ambient light, the light of surroundings, and lights with shadows.
class Illumination {
 public:
  /// `shadow_offset`: how far shadow rays start above their surface [m].
  Illumination(double ambient, const std::optional<FlickerOptions>& ambient_flicker,
               const std::vector<LightOptions>& lights, double shadow_offset,
               const std::optional<EnvironmentLight>& environment = std::nullopt);

  /// The lights that each of at most 16 points faces and that nothing hides from it. Of spots also
  /// those whose cone a point is outside of, so that a cone's edge is no edge of a shadow: with
  /// `within_cones` without them, which takes no ray. `known`: one per point, or none.
  void find_unoccluded_lights(std::span<const LitPoint> points, const Visibility& blockers,
                              std::span<LightSet> lights, bool within_cones = false,
                              std::span<const KnownLights> known = {}) const;

  /// Radiance per albedo: ambient + environment(normal) + sum of intensity cos(angle) / distance^2
  /// (of directional lights without the distance, of spots times the falloff of their cone, of
  /// emitters times the cosine at their normal) over `lights`, each times its flicker.
  [[nodiscard]] double irradiance(const LitPoint& point, LightSet lights) const;

  /// The bounds of irradiance() from `from` to `to`, two points of a surface at the ends of an
  /// interval that `lights` light throughout, and at `middle` halfway in time, of which only spots
  /// ask. The cosine over the distance squared is taken to stay near the line between both ends;
  /// the falloff of cones and the flicker are bounded in closed form. `normal`: bounds of a shading
  /// normal that may leave the line between both ends'.
  [[nodiscard]] LightRange irradiance_range(const LitPoint& from, const Eigen::Vector3d& middle,
                                            const LitPoint& to, LightSet lights,
                                            const VectorRange* normal = nullptr) const;

  /// What a glossy surface mirrors of `lights` towards the eye: Gloss::factor() times what each
  /// light adds to irradiance(). Ambient light and surroundings are not mirrored.
  [[nodiscard]] double mirrored(const GlossyPoint& seen, const Gloss& gloss, LightSet lights) const;
  /// Its bounds, as irradiance_range(): the directions to the eye and to the lights are taken to
  /// stay near the line between both ends'.
  [[nodiscard]] LightRange mirrored_range(const GlossyPoint& from, const Eigen::Vector3d& middle,
                                          const GlossyPoint& to, const Gloss& gloss,
                                          LightSet lights,
                                          const VectorRange* normal = nullptr) const;

  /// All that there are, each once.
  [[nodiscard]] std::span<const Flicker> flickers() const { return flickers_; }

  /// Whether there are spots.
  [[nodiscard]] bool has_cones() const { return has_cones_; }
  /// Whether no point of a sphere is in front of a light that is an emitter, or in the cone of one
  /// that has one.
  [[nodiscard]] bool misses(std::size_t light, const Eigen::Vector3d& centre, double radius) const {
    return (cones_[light] && cones_[light]->misses(centre, radius)) ||
           (lights_[light].type == LightType::kEmitter &&
            lights_[light].direction.dot(centre - lights_[light].position) < -radius);
  }

  /// With unit directions.
  [[nodiscard]] std::span<const LightOptions> lights() const { return lights_; }
  [[nodiscard]] double shadow_offset() const { return shadow_offset_; }

 private:
  static constexpr std::size_t kSteady = static_cast<std::size_t>(-1);

  /// The index of a flicker, which is added if it is new.
  [[nodiscard]] std::size_t index_of(const std::optional<FlickerOptions>& options);
  /// Of a flicker by its index, or 1.
  [[nodiscard]] double factor(std::size_t flicker, const LitPoint& point) const;
  [[nodiscard]] LightRange factor_range(std::size_t flicker, double from_s, double to_s) const;
  /// What one light adds to irradiance(), and the bounds of that.
  [[nodiscard]] double irradiance_of(std::size_t light, const LitPoint& point) const;
  [[nodiscard]] LightRange irradiance_range_of(std::size_t light, const LitPoint& from,
                                               const Eigen::Vector3d& middle, const LitPoint& to,
                                               const VectorRange* normal) const;
  /// Of a light's intensity at a point what its cone leaves.
  [[nodiscard]] double falloff(std::size_t light, const LitPoint& point) const {
    return cones_[light] ? cones_[light]->falloff(point.position) : 1;
  }

  double ambient_;
  std::vector<LightOptions> lights_;
  std::vector<Flicker> flickers_;
  std::size_t ambient_flicker_;
  std::vector<std::size_t> light_flickers_;
  std::vector<std::optional<SpotCone>> cones_;  ///< of lights that are spots
  bool has_cones_ = false;
  double shadow_offset_;
  std::optional<EnvironmentLight> environment_;
};

}  // namespace saccade
