#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "estimator/depth/rays/ray_gatherer.h"

namespace saccade {

struct RegressionOptions {
  /// 1.5 px across holds the events of an edge at the error of a seed; a longer window mixes in
  /// curved edges.
  GatherWindow window;
  int iterations = 5;                ///< of reweighting, at most
  double converged = 0.01;           ///< decrease of the sum of squares, in variances, that ends it
  double tilt_sigma = 0.3;           ///< of m around 0; 0: m = 0
  double hysteresis_sigma_px = 0.5;  ///< of h around 0; 0: h = 0
  double offset_sigma_px = 10;       ///< of c around 0; 0: c = 0
};

/// Result of the regression, relative to the edgel it started from.
struct RegressionResult {
  bool ok = false;          ///< false: too few events or no parallax
  float change = 0;         ///< of the inverse depth [1/m]
  float offset_px = 0;      ///< c
  float tilt = 0;           ///< m
  float hysteresis_px = 0;  ///< h
  float sigma = 0;          ///< of the inverse depth, from the residuals [1/m]
  float residual_px = 0;    ///< robust standard deviation of the residuals
  float support = 0;        ///< sum of the weights
  float cut_px = 0;         ///< residuals beyond it have no weight
};

/// Events that edgels explain, with their weights in the regression.
struct EdgelEvents {
  std::vector<std::uint32_t> event;
  std::vector<float> weight;
};

/// The inverse depth at which the rays pass through one straight line (Tukey's biweight, weights
/// from the median of the residuals):
///   n . (a + b rho - e) = c + m s + h p
/// with s the coordinate along the edgel. c is the error of the seed's position, m that of its
/// direction, h the hysteresis: ON and OFF events of one edge fire on different sides of it.
/// `prior_sigma`: of the change of rho around 0 [1/m].
[[nodiscard]] RegressionResult regress(
    const RayNeighbourhood& near, const RegressionOptions& options,
    double prior_sigma = std::numeric_limits<double>::infinity());

/// Appends the events with a weight above 0 at the solution.
void append_events(const RayNeighbourhood& near, const RegressionResult& result,
                   EdgelEvents& events);

/// The edgel after the regression.
[[nodiscard]] Edgel moved(const Edgel& edge, const RegressionResult& result);

}  // namespace saccade
