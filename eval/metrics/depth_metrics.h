#pragma once

#include <optional>
#include <span>
#include <vector>

#include "eval/metrics/depth_truth.h"
#include "eval/metrics/metrics.h"

namespace saccade {

/// A point that an estimate claims in one view.
struct DepthPoint {
  Eigen::Vector2d pixel;  ///< undistorted, sub-pixel
  double depth_m = 0;     ///< > 0
  std::optional<double> sigma_m;
};

/// The error of one point.
struct DepthError {
  double depth_m = 0;       ///< as estimated
  double difference_m = 0;  ///< estimate - truth
  double relative = 0;      ///< |estimate - truth| / truth
  std::optional<double> sigma_m;
};

/// The errors of one view, of the points where the truth is known.
struct DepthErrors {
  double t_s = 0;
  std::size_t points = 0;             ///< in the image, scored or not
  std::vector<DepthPoint> scored;     ///< the points that `best` is about, in the same order
  std::vector<DepthError> best;       ///< against the best pixel of the 3 x 3 around the point
  std::vector<DepthError> strict;     ///< against the truth at the very position
  std::size_t edge_pixels = 0;        ///< of the truth
  std::size_t found_edge_pixels = 0;  ///< with a point within their 3 x 3 neighbourhood
};

/// Compares the points with the truth. At the very position 1 / z of the four pixels around it is
/// interpolated; where these are not on one surface (10 %), the nearest pixel counts.
[[nodiscard]] DepthErrors compare_depth(std::span<const DepthPoint> points, const DepthTruth& truth,
                                        double t_s);

/// Sets, over all points of all views,
///   depth.{rel_mean,rel_median,rmse_m,delta_1_25,outlier_5_percent,within_1_sigma,within_2_sigma},
/// the same below depth.strict, depth.points (a number), depth.completeness (over all edge pixels);
/// depth.views.count; and of the views' own figures depth.views.{rel_mean,rel_median,
/// outlier_5_percent,completeness,points}.{median,worst}. Relative errors and fractions of points
/// are in 0..1, not percent. Null where there is nothing to score, or no sigma.
void set_depth_scores(Metrics& metrics, std::span<const DepthErrors> views);

/// The figures of one view, without the prefix.
[[nodiscard]] Metrics view_scores(const DepthErrors& view);

}  // namespace saccade
