#pragma once

#include <cstddef>
#include <optional>

#include <Eigen/Core>

#include "core/config/fields.h"
#include "simulator/scene/light/flicker.h"

namespace saccade {

/// Of an area light, emitters stand for it in a scene (emitters_of()).
enum class LightType { kPoint, kDirectional, kSpot, kRectangle, kDisc, kEmitter };

/// A light of a scene (item of `scene.lights`).
struct LightOptions {
  LightType type = LightType::kPoint;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();     ///< [m]; of a directional light unused
  Eigen::Vector3d direction = -Eigen::Vector3d::UnitZ();  ///< of a point light unused
  double intensity = 1;
  bool shadows = true;
  std::optional<FlickerOptions> flicker = std::nullopt;       ///< of its intensity
  double inner_angle_deg = 0, outer_angle_deg = 45;           ///< of a spot, from its axis
  Eigen::Vector2d size_m{1, 1};                               ///< of a rectangle
  Eigen::Vector3d width_direction = Eigen::Vector3d::Zero();  ///< of a rectangle; zero: level
  double radius_m = 0.5;                                      ///< of a disc
  std::size_t samples_per_side = 4;  ///< of an area light: its square are emitters

  /// Light that comes from a point, not from afar.
  [[nodiscard]] bool has_position() const { return type != LightType::kDirectional; }
  [[nodiscard]] bool is_area() const {
    return type == LightType::kRectangle || type == LightType::kDisc;
  }
};

/// A cone falls off over at least this: over less, its falloff is lost in rounding [deg].
inline constexpr double kLeastFalloff_deg = 0.01;

void describe(config::Fields& fields, LightOptions& options);

}  // namespace saccade
