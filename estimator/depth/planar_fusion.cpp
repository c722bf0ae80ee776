#include "estimator/depth/planar_fusion.h"

#include <cmath>

namespace saccade {
namespace {

constexpr float kOutlier = 4.685F;        ///< deviations of a point from its plane
constexpr float kAlwaysAllowed = 0.005F;  ///< relative

/// Whether its neighbourhood supports a point.
bool is_supported(const EdgeDepth& point, const LocalPlane& plane, const FusionOptions& options) {
  const float change = std::abs(plane.inverse_depth - point.inverse_depth);
  return plane.weights >= static_cast<float>(options.min_neighbours + 1) &&
         change <= kOutlier * plane.spread * point.sigma + kAlwaysAllowed * point.inverse_depth;
}

float sigma_of(const LocalPlane& plane, const FusionOptions& options) {
  const float few = static_cast<float>(options.few_weights) / plane.weights;
  const float fit = static_cast<float>(options.sigma_scale) * plane.spread * plane.sigma;
  const float surface = static_cast<float>(options.few_error) * few * plane.inverse_depth;
  const float common = static_cast<float>(options.floor) * plane.inverse_depth;
  return std::sqrt(fit * fit * (1 + few * few) + surface * surface + common * common);
}

/// What a point's own place and neighbourhood add to the deviation of its plane.
float local_sigma_of(const EdgeDepth& point, const LocalPlane& plane,
                     const FusionOptions& options) {
  const float place = static_cast<float>(options.position_error_px) * plane.slope.norm();
  const float own =
      static_cast<float>(options.own_share) * (point.inverse_depth - plane.inverse_depth);
  const float scatter = static_cast<float>(options.scatter_share) * point.sigma *
                        std::sqrt(plane.spread * plane.spread - 1);
  return std::sqrt(place * place + own * own + scatter * scatter);
}

}  // namespace

std::vector<EdgeDepth> supported(const std::vector<EdgeDepth>& points,
                                 const FusionOptions& options) {
  if (!(options.plane.radius_px > 0) || points.empty()) return points;
  LocalPlanes planes(points, options.plane);
  std::vector<EdgeDepth> kept;
  for (const EdgeDepth& point : points)
    if (is_supported(point, planes.fit(point), options)) kept.push_back(point);
  return kept;
}

std::vector<EdgeDepth> fused(const std::vector<EdgeDepth>& points, const FusionOptions& options) {
  if (!(options.plane.radius_px > 0) || points.empty()) return points;
  LocalPlanes planes(points, options.plane);
  std::vector<EdgeDepth> result;
  for (const EdgeDepth& point : points) {
    const LocalPlane plane = planes.fit(point);
    if (!is_supported(point, plane, options)) continue;
    const float sigma = sigma_of(plane, options);
    if (sigma > static_cast<float>(options.max_sigma) * plane.inverse_depth) continue;
    const Eigen::Vector2f shift = static_cast<float>(options.step_shift_px) *
                                  static_cast<float>(planes.surface_side(point, plane)) *
                                  point.normal;
    EdgeDepth smooth = point;
    smooth.x_px += shift.x();
    smooth.y_px += shift.y();
    smooth.inverse_depth = plane.inverse_depth + plane.slope.dot(shift);
    smooth.sigma = std::hypot(sigma, local_sigma_of(point, plane, options));
    if (smooth.inverse_depth > 0) result.push_back(smooth);
  }
  return result;
}

}  // namespace saccade
