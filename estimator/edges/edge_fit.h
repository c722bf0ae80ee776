#pragma once

#include <optional>
#include <span>

#include "core/camera.h"
#include "estimator/edges/edge_residual.h"

namespace saccade {

/// Gaussian prior on an edge's unknowns: what is assumed before its events.
struct EdgePrior {
  EdgeUnknowns mean;
  EdgeUnknowns sigma;
};

/// An edge by itself, the camera's path being known: its unknowns by Gauss-Newton with the weights
/// of Cauchy's loss (EdgeNoise), from `start`. `sigma_px` is the standard deviation of an event.
/// nullopt where the events do not determine it, or place it behind the view.
[[nodiscard]] std::optional<EdgeUnknowns> fit_edge(std::span<const EdgeObservation> events,
                                                   const PinholeCamera& camera,
                                                   const EdgeUnknowns& start,
                                                   const EdgePrior& prior, double sigma_px);

}  // namespace saccade
