#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulator/scene/scene.h"

namespace saccade {

/// What one ray of a pixel sees at an instant, and how that point moves over the texture.
struct RaySample {
  TriangleId triangle = kNothing;
  SurfaceSample surface;
  double x_rate = 0,
         y_rate = 0;      ///< [texel/s]; without a texture x_rate is that of the albedo [1/s]
  double level_rate = 0;  ///< of the level of the texture's pyramid [1/s]
};

/// L = ln(eps + I). Not inline: every caller must round alike, or a signal that returns to a former
/// level would reach its former threshold in one caller and miss it in another.
[[nodiscard]] double log_intensity(double radiance, double log_eps);

/// Bounds of a radiance and of its rate of change over an interval of time.
struct RadianceRange {
  static constexpr double kUnknown = std::numeric_limits<double>::infinity();

  double low = -kUnknown, high = kUnknown;
  double rate_low = -kUnknown, rate_high = kUnknown;  ///< [1/s]

  /// Of the mean of several rays, from their sum.
  void add(const RadianceRange& other) {
    low += other.low;
    high += other.high;
    rate_low += other.rate_low;
    rate_high += other.rate_high;
  }
  void scale(double factor) {
    low *= factor;
    high *= factor;
    rate_low *= factor;
    rate_high *= factor;
  }

  /// Bound of how far ln(eps + I) departs from its chord over `length_s`: a quarter of the spread
  /// of its rates times the length, or the spread of its values.
  [[nodiscard]] double log_error(double log_eps, double length_s) const;

  /// Rises or falls throughout, but for a thousandth of its steepest rate.
  [[nodiscard]] bool is_monotone() const {
    const double slack = 1e-3 * std::max(std::abs(rate_low), std::abs(rate_high));
    return slack < kUnknown && (rate_low >= -slack || rate_high <= slack);
  }
};

/// Of a ray that sees the same triangle at both ends of an interval of `length_s` > 0 and all
/// through it. Over the texture the ray follows the cubic with the given ends; it departs from the
/// chord by at most 4/27 of the sum of both ends' differences from the chord's rate, times the
/// length. A box within one cell of the texture is bounded by the bilinear function there, which
/// also bounds the rate; a larger one by its texels. Filtered textures likewise, on both levels
/// around the path's. `light`: bounds of the irradiance where it may leave the line between both
/// ends'; else it is taken to stay near that.
[[nodiscard]] RadianceRange radiance_range(const RaySample& from, const RaySample& to,
                                           double length_s, const LightRange* light = nullptr);

/// The cubic at `fraction` of the interval. The irradiance is the line between both ends'.
[[nodiscard]] RaySample interpolate(const RaySample& from, const RaySample& to, double length_s,
                                    double fraction);

/// Whether the cubic is as good as the true path: the path is nearly straight.
[[nodiscard]] bool is_straight(const RaySample& from, const RaySample& to, double length_s);

/// Where to divide the interval of a ray so that its parts become monotone: the crossing of a
/// texel's (or level's) border nearest to the middle; within one cell the radiance's extremum; else
/// the middle. A fraction within [0.02, 0.98].
[[nodiscard]] double split_fraction(const RaySample& from, const RaySample& to, double length_s);

}  // namespace saccade
