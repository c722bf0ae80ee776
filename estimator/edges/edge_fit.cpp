#include "estimator/edges/edge_fit.h"

#include <vector>

#include <Eigen/Cholesky>

#include "estimator/edges/edge_noise.h"

namespace saccade {
namespace {

constexpr int kIterations = 4;

}  // namespace

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
