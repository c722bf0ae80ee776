#include "estimator/refinement/edge_fit.h"

#include <cmath>

#include <Eigen/Cholesky>

namespace saccade {
namespace {

constexpr int kIterations = 4;

}  // namespace

std::optional<EdgeUnknowns> fit_edge(std::span<const EdgeObservation> events,
                                     const PinholeCamera& camera, const EdgeUnknowns& start,
                                     const EdgePrior& prior, double noise_px, double outlier) {
  EdgeUnknowns edge = start;
  const Eigen::Vector4d precision = prior.sigma.cwiseInverse().cwiseAbs2();
  for (int i = 0; i < kIterations; ++i) {
    Eigen::Matrix4d information = precision.asDiagonal();
    Eigen::Vector4d gradient = precision.cwiseProduct(edge - prior.mean);
    for (const EdgeObservation& event : events) {
      EdgeDerivatives derivatives;
      const double residual = edge_residual(event, camera, Twist::Zero(), edge, &derivatives);
      if (!std::isfinite(residual)) return std::nullopt;
      const double deviations = residual / noise_px;
      const double weight =
          1 / (noise_px * noise_px * (1 + deviations * deviations / (outlier * outlier)));
      information += weight * derivatives.edge.transpose() * derivatives.edge;
      gradient += weight * residual * derivatives.edge.transpose();
    }
    edge -= information.ldlt().solve(gradient);
    if (!(edge[0] > 0)) return std::nullopt;
  }
  return edge;
}

}  // namespace saccade
