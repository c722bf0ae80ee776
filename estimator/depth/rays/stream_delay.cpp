#include "estimator/depth/rays/stream_delay.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace saccade {
namespace {

/// Of an edgel's own unknowns, relative: those that its events do not determine stay 0.
constexpr double kRidge = 1e-9;
/// Least part of the squared rates that an edgel's own unknowns leave; below it is what single precision and
/// the edgel's straight line make of a uniform motion.
constexpr double kLeastVariation = 1e-3;
constexpr double kLeastVariance_px2 = 1e-3;
/// What the residuals of all edgels have in common for other reasons, such as pixels that had not fired before: no
/// number of events lessens it. Worlds of ideal pixels, whose delay is 0, show a twentieth of it.
constexpr double kCommonError_px = 0.005;

/// What edgels say of the delay, their own unknowns marginalised; divided by the variance of their residuals.
struct Evidence {
  double rate2 = 0;  ///< sum of w (n . x')^2, as far as own unknowns leave it
  double rate_residual = 0;
  double weights = 0;
};

Evidence evidence_of(const FittedEdgel& edgel, const EventRays& rays,
                     std::span<const Event> window_events, const EdgelEvents& events) {
  const Eigen::Vector2d n = edgel.edge.normal.cast<double>(),
                        t = edgel.edge.tangent().cast<double>(),
                        e = edgel.edge.pixel.cast<double>();
  const auto rho = static_cast<double>(edgel.edge.inverse_depth);
  Eigen::Matrix4d own = Eigen::Matrix4d::Zero();
  Eigen::Vector4d own_rate = Eigen::Vector4d::Zero(), own_residual = Eigen::Vector4d::Zero();
  double rate2 = 0, rate_residual = 0;
  for (std::uint32_t i = edgel.first; i < edgel.last; ++i) {
    const std::uint32_t event = events.event[i];
    const auto w = static_cast<double>(events.weight[i]);
    const RayLine& line = rays.line[event];
    const RayGradient& gradient = rays.gradient[event];
    const double p = window_events[rays.source[event]].polarity;
    const Eigen::Vector2d b(line.bx, line.by);
    const Eigen::Vector2d from_edge = Eigen::Vector2d(line.ax, line.ay) + rho * b - e;
    const double rate = p * n.dot(Eigen::Vector2d(gradient.qax, gradient.qay) +
                                  rho * Eigen::Vector2d(gradient.qbx, gradient.qby));
    const double residual = n.dot(from_edge);
    const Eigen::Vector4d own_row(1, t.dot(from_edge), p, n.dot(b));
    own += w * own_row * own_row.transpose();
    own_rate += w * rate * own_row;
    own_residual += w * residual * own_row;
    rate2 += w * rate * rate;
    rate_residual += w * rate * residual;
  }
  const double weights = own(0, 0);
  own.diagonal() *= 1 + kRidge;
  const Eigen::Vector4d explained = own.ldlt().solve(own_rate);
  const double left = rate2 - own_rate.dot(explained);
  if (!(left > kLeastVariation * rate2)) return {};
  const double variance =
      std::max(kLeastVariance_px2, std::pow(static_cast<double>(edgel.residual_px), 2));
  return {left / variance, (rate_residual - own_residual.dot(explained)) / variance,
          weights / variance};
}

}  // namespace

StreamDelay StreamDelay::with_prior() const {
  constexpr double kSigma_s = 1e-3;
  if (!(sigma_s < kSigma_s)) return {0, kSigma_s};
  const double share = 1 / (1 + std::pow(sigma_s / kSigma_s, 2));
  return {share * delay_s, std::sqrt(share) * sigma_s};
}

StreamDelay estimate_delay(const EventRays& rays, std::span<const Event> window_events,
                           const std::vector<FittedEdgel>& edgels, const EdgelEvents& events) {
  Evidence all;
  for (const FittedEdgel& edgel : edgels) {
    const Evidence one = evidence_of(edgel, rays, window_events, events);
    all.rate2 += one.rate2;
    all.rate_residual += one.rate_residual;
    all.weights += one.weights;
  }
  if (!(all.rate2 > 0)) return {};
  const double common_s2 = kCommonError_px * kCommonError_px * all.weights / all.rate2;
  const double variance_s2 = 1 / all.rate2 + common_s2;
  return {all.rate_residual / all.rate2, std::sqrt(variance_s2)};
}

}  // namespace saccade
