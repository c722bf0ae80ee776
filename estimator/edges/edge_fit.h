#pragma once

#include <optional>
#include <span>

#include "core/camera.h"
#include "estimator/edges/edge_residual.h"
#include "estimator/edges/landmarks.h"

namespace saccade {

/// Gaussian prior on an edge's unknowns: what is assumed before its events.
struct EdgePrior {
  EdgeUnknowns mean;
  EdgeUnknowns sigma;
};

/// The prior of an edge: EdgeNoise's about `unknowns`, and of depth and position by the landmark that
/// the edge lies on, within 1.5 px and a tenth of its inverse depth, where there is one. It wants a
/// robust loss: not every landmark is on the edge.
[[nodiscard]] EdgePrior edge_prior(const Edgel& edge, const EdgeUnknowns& unknowns,
                                   const ProjectedLandmarks& landmarks);

/// An edge by itself, the camera's path being known: its unknowns by Gauss-Newton with the weights
/// of Cauchy's loss (EdgeNoise), from `start`. `sigma_px` is the standard deviation of an event.
/// nullopt where the events do not determine it, or place it behind the view.
[[nodiscard]] std::optional<EdgeUnknowns> fit_edge(std::span<const EdgeObservation> events,
                                                   const PinholeCamera& camera,
                                                   const EdgeUnknowns& start,
                                                   const EdgePrior& prior, double sigma_px);

}  // namespace saccade
