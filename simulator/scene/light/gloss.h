#pragma once

#include "simulator/scene/light/flicker.h"

namespace saccade {

namespace config {
class Fields;
}

/// How a surface mirrors lights: one lobe around the mirrored direction, of microfacets (GGX;
/// Walter et al., EGSR 2007) without self-shadowing and with the same reflectance from all sides. A
/// light that gives a white surface the radiance E adds
///   E reflectance lobe(sin^2 a),   lobe(s) = alpha^2 / (4 (alpha^2 + (1 - alpha^2) s)^2)
/// with a the angle between the shading normal and the direction halfway between eye and light.
struct Gloss {
  float reflectance = 0;  ///< 0: the surface is matt
  float alpha = 1;        ///< the lobe's width: the roughness squared

  [[nodiscard]] bool is_matt() const { return reflectance == 0; }
  /// reflectance lobe(s), for s in [0, 1].
  [[nodiscard]] double factor(double sine_squared) const;
  /// Its bounds, where those of s are known.
  [[nodiscard]] LightRange factor_range(LightRange sine_squared) const;
};

/// `gloss` of a mesh.
struct GlossOptions {
  double reflectance = 0.04;
  double roughness = 0.4;
};

/// The least roughness: smoother surfaces would mirror a point, which no real light is.
inline constexpr double kLeastRoughness = 0.1;

/// Of a surface as it is stated; rougher where it would be smoother than kLeastRoughness.
[[nodiscard]] Gloss make_gloss(double reflectance, double roughness);

void describe(config::Fields& fields, GlossOptions& options);

}  // namespace saccade
