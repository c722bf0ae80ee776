#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "estimator/depth/event_rays.h"

namespace saccade {

/// A short straight edge in the reference view with its depth.
struct RayEdge {
  Eigen::Vector2f pixel;    ///< on the edge
  Eigen::Vector2f normal;   ///< unit, towards the brighter side
  float inverse_depth = 0;  ///< [1/m]

  [[nodiscard]] Eigen::Vector2f tangent() const { return {-normal.y(), normal.x()}; }
};

/// Events that pass near an edge, in its coordinates at its inverse depth. Structure of arrays, of
/// size `padded()`; behind `count` the arrays hold zeros.
struct RayNeighbourhood {
  static constexpr std::size_t kLanes = 8;

  std::size_t count = 0;
  std::vector<std::uint32_t> event;  ///< index into the rays
  std::vector<float> across;         ///< n . (x(rho) - e) [px]
  std::vector<float> along;          ///< t . (x(rho) - e) [px]
  std::vector<float> parallax;       ///< n . b [px m]
  std::vector<float> polarity;       ///< +1, -1; 0 behind `count`

  /// Room for `more` events behind `count`, as garbage.
  void reserve(std::size_t more);
  /// Zeros up to padded().
  void pad();

  [[nodiscard]] std::size_t padded() const { return (count + kLanes - 1) / kLanes * kLanes; }
};

struct RegressionOptions {
  double radius_px = 2;              ///< across the edge, of the events that count
  double half_length_px = 1.5;       ///< along it
  int iterations = 4;                ///< of reweighting, per stage
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

/// Every `stride`-th slab of [first, last).
struct SlabSteps {
  int first = 0;
  int last = 0;
  int stride = 1;
};

/// Collects the events of the slabs that pass within `radius_px` across and
/// `half_length_px` along `edge` and whose polarity fits its normal, p x'(rho) . n > 0.
void gather_rays(const EventRays& rays, const SlabSteps& slabs, const RayEdge& edge,
                 const RegressionOptions& options, RayNeighbourhood& near);

/// The inverse depth at which the rays pass through one straight line (Tukey's biweight, weights
/// from the median of the residuals):
///   n . (a + b rho - e) = c + m s + h p
/// with s the coordinate along the edge. c absorbs the error of the seed's place, m that of its
/// direction, h that ON and OFF events of one edge fire on different sides of it.
[[nodiscard]] RegressionResult regress(const RayNeighbourhood& near,
                                       const RegressionOptions& options);

/// Weight of each event in the end.
[[nodiscard]] std::vector<float> weights_of(const RayNeighbourhood& near,
                                            const RegressionResult& result);

/// The edge after the change.
[[nodiscard]] RayEdge moved(const RayEdge& edge, const RegressionResult& result);

}  // namespace saccade
