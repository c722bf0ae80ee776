#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "estimator/depth/ray_gather.h"

namespace saccade {

struct RegressionOptions {
  GatherReach reach;                 ///< of the events that count
  int iterations = 5;                ///< of reweighting, per stage
  double tilt_prior = 0.3;           ///< deviation of the tilt m from 0; 0: no tilt
  double hysteresis_prior_px = 0.5;  ///< of h from 0; 0: no hysteresis
  double offset_prior_px = 10;       ///< of c from 0; 0: no offset
};

/// What the regression found, relative to the edge it started from.
struct RegressionResult {
  bool ok = false;          ///< false: too few events or no parallax
  float change = 0;         ///< of the inverse depth [1/m]
  float offset_px = 0;      ///< c
  float tilt = 0;           ///< m
  float hysteresis_px = 0;  ///< h
  float sigma = 0;          ///< of the inverse depth, from the residuals [1/m]
  float residual_px = 0;    ///< robust deviation of the residuals
  float support = 0;        ///< sum of the weights
  float cut_px = 0;         ///< residuals beyond it have no weight
};

/// Which events each edge explains, and how well: the weights of the regression.
struct EdgeEvents {
  std::vector<std::uint32_t> event;
  std::vector<float> weight;
};

/// The inverse depth at which the rays pass through one straight line (Tukey's biweight, weights
/// from the median of the residuals):
///   n . (a + b rho - e) = c + m s + h p
/// with s the coordinate along the edge. c absorbs the error of the seed's place, m that of its
/// direction, h that ON and OFF events of one edge fire on different sides of it.
/// `prior`: deviation of the change of rho from 0, [1/m].
[[nodiscard]] RegressionResult regress(const RayNeighbourhood& near,
                                       const RegressionOptions& options,
                                       double prior = std::numeric_limits<double>::infinity());

/// Appends the events that have weight in the end.
void append_events(const RayNeighbourhood& near, const RegressionResult& result,
                   EdgeEvents& events);

/// The edge after the change.
[[nodiscard]] RayEdge moved(const RayEdge& edge, const RegressionResult& result);

}  // namespace saccade
