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
    EdgeDepth smooth = point;
    smooth.inverse_depth = plane.inverse_depth;
    smooth.sigma = sigma_of(plane, options);
    if (smooth.sigma > static_cast<float>(options.max_sigma) * smooth.inverse_depth) continue;
    if (smooth.inverse_depth > 0) result.push_back(smooth);
  }
  return result;
}

}  // namespace saccade
