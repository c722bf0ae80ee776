#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "simulator/scene/intersection/visibility.h"
#include "simulator/scene/light/flicker.h"
#include "simulator/scene/scene_options.h"

namespace saccade {

/// A point on a surface in the world, with unit normals on the side that is seen.
struct LitPoint {
  Eigen::Vector3d position;
  Eigen::Vector3d plane_normal;
  Eigen::Vector3d shading_normal;
  double time_s;  ///< at which it is seen
  double span_s;  ///< around it, over which flickering light is averaged
};

/// What falls onto a Lambertian surface: ambient light and lights with shadows.
class Illumination {
 public:
  /// `shadow_offset`: how far shadow rays start above their surface [m].
  Illumination(double ambient, const std::optional<FlickerOptions>& ambient_flicker,
               const std::vector<LightOptions>& lights, double shadow_offset);

  /// The lights that each of at most 16 points faces and that nothing hides from it.
  void find_unoccluded_lights(std::span<const LitPoint> points, const Visibility& blockers,
                              std::span<LightSet> lights) const;

  /// Radiance per albedo: ambient + sum of intensity cos(angle) / distance^2 (of directional lights
  /// without the distance) over `lights`, each times its flicker.
  [[nodiscard]] double irradiance(const LitPoint& point, LightSet lights) const;

  /// The bounds of irradiance() from `from` to `to`, two points of a surface at the ends of an
  /// interval that `lights` light throughout. The cosine over the distance squared is taken to stay
  /// near the line between both ends; the flicker is bounded in closed form.
  [[nodiscard]] LightRange irradiance_range(const LitPoint& from, const LitPoint& to,
                                            LightSet lights) const;

  /// All that there are, each once.
  [[nodiscard]] std::span<const Flicker> flickers() const { return flickers_; }

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

  double ambient_;
  std::vector<LightOptions> lights_;
  std::vector<Flicker> flickers_;
  std::size_t ambient_flicker_;
  std::vector<std::size_t> light_flickers_;
  double shadow_offset_;
};

}  // namespace saccade
