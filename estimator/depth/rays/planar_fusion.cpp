#include "estimator/depth/rays/planar_fusion.h"

#include <cmath>
#include <cstddef>
#include <optional>

#include "core/process/parallel.h"
#include "estimator/depth/rays/biweight.h"

namespace saccade {
namespace {

/// Shift of a point on an occluding contour onto the surface that ends there: on the contour the pixel
/// is as likely the surface behind.
constexpr float kContourShift_px = 0.5F;
constexpr float kAlwaysAllowed = 0.005F;  ///< relative distance from the plane that is no outlier

// The model of sigma, fitted to the errors on Walls, Planes, Dunes and Boxes (docs/depth.md).
constexpr float kSigmaScale = 1.1F;  ///< a: above 1 since neighbours share events
constexpr float kSparseWeight = 14;  ///< w_0: a plane of this weight has twice the variance
constexpr float kSparseModelError = 0.0015F;  ///< m: relative, of a surface through w_0 points
constexpr float kMinRelativeSigma = 0.0004F;  ///< f: errors that all neighbours have in common
constexpr float kResidualRatio = 0.4F;        ///< o
constexpr float kScatterRatio = 0.15F;        ///< c

LocalPlane plane_at(const EdgePoint& point, LocalPlanes& planes, const FusionOptions& options) {
  return options.widens ? planes.fit_widened(point) : planes.fit(point);
}

/// Whether a point agrees with its neighbourhood.
bool is_supported(const EdgePoint& point, const LocalPlane& plane, const FusionOptions& options) {
  const float change = std::abs(plane.inverse_depth - point.inverse_depth);
  return plane.weights >= static_cast<float>(options.min_neighbours + 1) &&
         change <=
             kBiweightCutoff * plane.spread * point.sigma + kAlwaysAllowed * point.inverse_depth;
}

float sigma_of(const LocalPlane& plane) {
  const float sparse = kSparseWeight / plane.weights;
  const float fit = kSigmaScale * plane.spread * plane.sigma;
  const float surface = kSparseModelError * sparse * plane.inverse_depth;
  const float common = kMinRelativeSigma * plane.inverse_depth;
  return std::sqrt(fit * fit * (1 + sparse * sparse) + surface * surface + common * common);
}

/// What a point's own position and neighbourhood add to the standard deviation of its plane.
float local_sigma_of(const EdgePoint& point, const LocalPlane& plane,
                     const FusionOptions& options) {
  const float position = static_cast<float>(options.position_sigma_px) * plane.slope.norm();
  const float residual = kResidualRatio * (point.inverse_depth - plane.inverse_depth);
  const float scatter = kScatterRatio * point.sigma * std::sqrt(plane.spread * plane.spread - 1);
  return std::sqrt(position * position + residual * residual + scatter * scatter);
}

/// nullopt for one that is dropped.
std::optional<EdgePoint> fused(const EdgePoint& point, LocalPlanes& planes,
                               const FusionOptions& options) {
  const LocalPlane plane = plane_at(point, planes, options);
  if (!is_supported(point, plane, options)) return std::nullopt;
  const float sigma = sigma_of(plane);
  if (!(std::hypot(sigma, point.pose_sigma) <=
        static_cast<float>(options.max_sigma) * plane.inverse_depth))
    return std::nullopt;
  const Eigen::Vector2f shift =
      kContourShift_px * static_cast<float>(planes.surface_side(point, plane)) * point.normal;
  EdgePoint smooth = point;
  smooth.x_px += shift.x();
  smooth.y_px += shift.y();
  smooth.inverse_depth = plane.inverse_depth + plane.slope.dot(shift);
  smooth.sigma = std::hypot(sigma, local_sigma_of(point, plane, options), point.pose_sigma);
  if (!(smooth.inverse_depth > 0)) return std::nullopt;
  return smooth;
}

/// What `of_point` makes of each point and the planes through all, in their order.
template <class OfPoint>
std::vector<EdgePoint> of_points(const std::vector<EdgePoint>& points, const FusionOptions& options,
                                 const OfPoint& of_point) {
  constexpr std::size_t kGrain = 1024;
  const LocalPlanes planes(points, options.plane);
  std::vector<std::vector<EdgePoint>> parts((points.size() + kGrain - 1) / kGrain);
  parallel_for_ranges(points.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    LocalPlanes own_planes = planes;  // fit() is not thread-safe
    for (std::size_t i = begin; i < end; ++i)
      if (const std::optional<EdgePoint> made = of_point(points[i], own_planes))
        parts[begin / kGrain].push_back(*made);
  });
  std::vector<EdgePoint> all;
  for (const std::vector<EdgePoint>& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace

void describe(config::Fields& fields, FusionOptions& options) {
  fields
      .value("min_neighbours", options.min_neighbours,
             "Points with a smaller sum of weights of their neighbours are dropped; larger values "
             "give fewer and better points.")
      .range(0, 1000);
  fields
      .value("max_sigma", options.max_sigma,
             "Points whose plane has a larger standard deviation, divided by the inverse depth, "
             "are dropped; larger values give more and less accurate points.")
      .above(0);
}

std::vector<EdgePoint> supported_points(const std::vector<EdgePoint>& points,
                                        const FusionOptions& options) {
  return of_points(points, options, [&](const EdgePoint& point, LocalPlanes& planes) {
    const bool is_kept = is_supported(point, plane_at(point, planes, options), options);
    return is_kept ? std::optional(point) : std::nullopt;
  });
}

std::vector<EdgePoint> fuse_planes(const std::vector<EdgePoint>& points,
                                   const FusionOptions& options) {
  return of_points(points, options, [&](const EdgePoint& point, LocalPlanes& planes) {
    return fused(point, planes, options);
  });
}

}  // namespace saccade
