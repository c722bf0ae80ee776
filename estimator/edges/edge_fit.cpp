#include "estimator/edges/edge_fit.h"

#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Cholesky>

#include "estimator/edges/edge_noise.h"
#include "estimator/lanes.h"

namespace saccade {
namespace {

constexpr int kIterations = 4;

/// kDoubleLanes EdgeLines of one edge, packed. A lane without an event has the weight 0.
struct LineLanes {
  DoubleLanes across_px{}, across_by_rho{}, along_px{}, along_by_rho{}, origin_z{}, lag{};
  DoubleLanes per_forward = DoubleLanes{} + 1;
  DoubleLanes weight{};

  void set(std::size_t lane, const EdgeLine& line) {
    across_px[lane] = line.across_px;
    across_by_rho[lane] = line.across_by_rho;
    along_px[lane] = line.along_px;
    along_by_rho[lane] = line.along_by_rho;
    origin_z[lane] = line.origin_z;
    lag[lane] = line.lag;
    per_forward[lane] = 1 / line.forward;
    weight[lane] = 1;
  }
};

/// The normal equations of an edge's events, J^T W J and J^T W r, as sums over lanes.
struct FitSums {
  DoubleLanes square[4][4]{};  ///< the lower triangle
  DoubleLanes gradient[4]{};
  DoubleLanes behind{};  ///< how many events are not in front of the view: g is not above 0

  /// Residuals as of EdgeLine, in pixels of the sensor; with the weights of Cauchy's loss.
  void add(const LineLanes& line, const EdgeUnknowns& edge, double sigma_px) {
    constexpr double kScale = EdgeNoise::kCauchyScale;
    const double rho = edge[0], m = edge[2];
    const DoubleLanes shrinking = line.origin_z * line.per_forward;
    const DoubleLanes g = line.per_forward - rho * shrinking;
    const DoubleLanes per_g = 1 / g;
    const DoubleLanes along = line.along_px + rho * line.along_by_rho;
    const DoubleLanes r =
        (line.across_px + rho * line.across_by_rho - edge[1] - m * along - edge[3] * line.lag) *
        per_g;
    const DoubleLanes x = r * (1 / (sigma_px * kScale));
    const DoubleLanes weight = line.weight * (1 / (sigma_px * sigma_px)) / (1 + x * x);
    const DoubleLanes by[4] = {(line.across_by_rho - m * line.along_by_rho + r * shrinking) * per_g,
                               -per_g, -along * per_g, -line.lag * per_g};
    for (int i = 0; i < 4; ++i) {
      const DoubleLanes weighted = weight * by[i];
      for (int j = 0; j <= i; ++j) square[i][j] += weighted * by[j];
      gradient[i] += weighted * r;
    }
    behind += g > 0 ? DoubleLanes{} : DoubleLanes{} + 1;
  }

  [[nodiscard]] bool is_in_front() const { return total(behind) == 0; }
};

}  // namespace

EdgePrior edge_prior(const Edgel& edge, const EdgeUnknowns& unknowns,
                     const ProjectedLandmarks& landmarks) {
  constexpr double kReach_px = 1.5;
  constexpr double kTolerance = 0.1;
  // A landmark and the edge are measurements of one edge from two views: so much may lie between them
  // across the edge, and in depth, relative, beside what the landmark's own sigma says.
  constexpr double kAcrossSigma_px = 0.1;
  constexpr double kDepthSigma = 0.003;
  EdgePrior prior{unknowns, EdgeNoise::prior_sigma(unknowns[0])};
  if (const auto* landmark = landmarks.nearest(edge, kReach_px, kTolerance)) {
    prior.mean[0] = landmark->inverse_depth;
    prior.sigma[0] = std::hypot(landmark->sigma, kDepthSigma * landmark->inverse_depth);
    prior.mean[1] = edge.normal.cast<double>().dot(landmark->pixel - edge.pixel.cast<double>());
    prior.sigma[1] = kAcrossSigma_px;
  }
  return prior;
}

std::optional<EdgeUnknowns> fit_edge(std::span<const EdgeObservation> events,
                                     const PinholeCamera& camera, const EdgeUnknowns& start,
                                     const EdgePrior& prior, double sigma_px) {
  std::vector<LineLanes> lines((events.size() + kDoubleLanes - 1) / kDoubleLanes);
  for (std::size_t i = 0; i < events.size(); ++i) {
    const EdgeLine line = line_of(events[i], camera);
    if (!(line.forward > 0)) return std::nullopt;
    lines[i / kDoubleLanes].set(i % kDoubleLanes, line);
  }
  EdgeUnknowns edge = start;
  const Eigen::Vector4d precision = prior.sigma.cwiseInverse().cwiseAbs2();
  for (int i = 0; i < kIterations; ++i) {
    FitSums sums;
    for (const LineLanes& line : lines) sums.add(line, edge, sigma_px);
    if (!sums.is_in_front()) return std::nullopt;
    Eigen::Matrix4d information = precision.asDiagonal();
    Eigen::Vector4d gradient = precision.cwiseProduct(edge - prior.mean);
    for (int row = 0; row < 4; ++row) {
      gradient[row] += total(sums.gradient[row]);
      for (int column = 0; column <= row; ++column)
        information(row, column) += total(sums.square[row][column]);
    }
    // Of a symmetric matrix LDLT reads the lower triangle alone.
    edge -= information.ldlt().solve(gradient);
    if (!(edge[0] > 0)) return std::nullopt;
  }
  return edge;
}

}  // namespace saccade
