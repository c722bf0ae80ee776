#pragma once

#include <optional>
#include <span>

#include "core/camera.h"
#include "estimator/refinement/edge_residual.h"

namespace saccade {

/// What is assumed of an edge before its events are looked at.
struct EdgePrior {
  EdgeUnknowns mean;
  EdgeUnknowns sigma;
};

/// An edge by itself, the camera's path being known: its unknowns by Gauss-Newton with the weights
/// of Cauchy's loss, from `start`. `noise_px` is the deviation of an event, `outlier` how many of
/// them are one. nullopt where the events do not tell, or tell of no place in front of the view.
[[nodiscard]] std::optional<EdgeUnknowns> fit_edge(std::span<const EdgeObservation> events,
                                                   const PinholeCamera& camera,
                                                   const EdgeUnknowns& start,
                                                   const EdgePrior& prior, double noise_px,
                                                   double outlier);

}  // namespace saccade
