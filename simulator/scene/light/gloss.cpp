#include "simulator/scene/light/gloss.h"

#include <algorithm>
#include <cmath>

#include "core/config/fields.h"
#include "simulator/scene/light/vector_range.h"

namespace saccade {
namespace {

/// alpha^2 + (1 - alpha^2) s, whose square the lobe is divided by.
double spread(double alpha, double sine_squared) {
  return alpha * alpha + (1 - alpha * alpha) * sine_squared;
}

}  // namespace

double Gloss::factor(double sine_squared) const {
  const double a = static_cast<double>(alpha);
  const double divisor = spread(a, sine_squared);
  return static_cast<double>(reflectance) * a * a / (4 * divisor * divisor);
}

LightRange Gloss::factor_range(LightRange sine_squared) const {
  sine_squared.low = std::clamp(sine_squared.low, 0.0, 1.0);
  sine_squared.high = std::clamp(sine_squared.high, 0.0, 1.0);
  const double a = static_cast<double>(alpha);
  // The slope over s, steepest where s is least.
  const auto slope = [&](double s) { return -2 * (1 - a * a) / spread(a, s) * factor(s); };
  const LightRange slopes{slope(sine_squared.low), slope(sine_squared.high), 0, 0};
  const LightRange rates = product(slopes, {sine_squared.rate_low, sine_squared.rate_high, 0, 0});
  return {factor(sine_squared.high), factor(sine_squared.low), rates.low, rates.high};
}

Gloss make_gloss(double reflectance, double roughness) {
  const double kept = std::clamp(roughness, kLeastRoughness, 1.0);
  return {static_cast<float>(reflectance), static_cast<float>(kept * kept)};
}

void describe(config::Fields& fields, GlossOptions& options) {
  fields
      .value(
          "reflectance", options.reflectance,
          "Part of the light that the surface mirrors: 0.04 of varnish, plastic or glass, 0.5 to "
          "1 of metals.")
      .range(0, 1);
  fields
      .value("roughness", options.roughness,
             "Width of the highlights, as glTF has it: 0.1 is polished, 1 almost matt.")
      .range(kLeastRoughness, 1);
}

}  // namespace saccade
