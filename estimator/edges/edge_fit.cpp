#include "estimator/edges/edge_fit.h"

#include <cmath>
#include <vector>

#include <Eigen/Cholesky>

#include "estimator/edges/edge_noise.h"

namespace saccade {
namespace {

constexpr int kIterations = 4;

}  // namespace

EdgePrior edge_prior(const Edgel& edge, const EdgeUnknowns& unknowns,
                     const ProjectedLandmarks& landmarks, const LandmarkNoise& noise) {
  constexpr double kReach_px = 1.5;
  constexpr double kTolerance = 0.1;
  EdgePrior prior{unknowns, EdgeNoise::prior_sigma(unknowns[0])};
  if (noise.sigma_px <= 0) return prior;
  if (const auto* landmark = landmarks.nearest(edge, kReach_px, kTolerance)) {
    prior.mean[0] = landmark->inverse_depth;
    prior.sigma[0] = std::hypot(landmark->sigma, noise.depth_sigma * landmark->inverse_depth);
    prior.mean[1] = edge.normal.cast<double>().dot(landmark->pixel - edge.pixel.cast<double>());
    prior.sigma[1] = noise.sigma_px;
  }
  return prior;
}

std::optional<EdgeUnknowns> fit_edge(std::span<const EdgeObservation> events,
                                     const PinholeCamera& camera, const EdgeUnknowns& start,
                                     const EdgePrior& prior, double sigma_px) {
  constexpr double kScale = EdgeNoise::kCauchyScale;
  std::vector<EdgeLine> lines;
  lines.reserve(events.size());
  for (const EdgeObservation& event : events) lines.push_back(line_of(event, camera));
  EdgeUnknowns edge = start;
  const Eigen::Vector4d precision = prior.sigma.cwiseInverse().cwiseAbs2();
  for (int i = 0; i < kIterations; ++i) {
    Eigen::Matrix4d information = precision.asDiagonal();
    Eigen::Vector4d gradient = precision.cwiseProduct(edge - prior.mean);
    for (const EdgeLine& line : lines) {
      const double g = line.magnification(edge[0]);
      if (!(line.forward > 0 && g > 0)) return std::nullopt;
      const double r = line.residual_in_view_px(edge) / g / sigma_px;
      const double weight = 1 / (sigma_px * sigma_px * (1 + r * r / (kScale * kScale)));
      const Eigen::Matrix<double, 1, 4> by_edge = line.by_edge(edge);
      information += weight * by_edge.transpose() * by_edge;
      gradient += weight * r * sigma_px * by_edge.transpose();
    }
    edge -= information.ldlt().solve(gradient);
    if (!(edge[0] > 0)) return std::nullopt;
  }
  return edge;
}

}  // namespace saccade
