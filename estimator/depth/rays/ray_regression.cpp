#include "estimator/depth/rays/ray_regression.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "estimator/depth/rays/biweight.h"

namespace saccade {
namespace {

constexpr std::size_t kUnknowns = 4;  ///< c, m, h, rho; rho last
constexpr std::size_t kMinEvents = 10;
constexpr float kMinScale_px = 0.1F;

using HalfLanes = float __attribute__((vector_size(kLanes / 2 * sizeof(float))));

double sum_of(const Lanes& lanes) {
  std::array<HalfLanes, 2> halves;
  std::memcpy(halves.data(), &lanes, sizeof(lanes));
  const HalfLanes pairs = halves[0] + halves[1];
  return static_cast<double>((pairs[0] + pairs[4]) + (pairs[1] + pairs[5])) +
         static_cast<double>((pairs[2] + pairs[6]) + (pairs[3] + pairs[7]));
}

struct Parameters {
  float offset = 0, tilt = 0, hysteresis = 0, change = 0;
};

/// Symmetric normal equations A x = b in the order c, m, h, rho: the lower triangle.
struct Normal {
  std::array<std::array<double, kUnknowns>, kUnknowns> a{};
  std::array<double, kUnknowns> b{};
  double squares = 0;  ///< sum of w r^2
  double weights = 0;  ///< sum of w
};

/// Weighted normal equations of the residual r = across + B drho - c - m s - h p.
Normal accumulate(const RayNeighbourhood& n, const Parameters& p, float cut) {
  Lanes w_{}, ws_{}, wq_{}, wb_{}, wss{}, wsq{}, wsb{}, wqq{}, wqb{}, wbb{}, wr_{}, wsr{}, wqr{},
      wbr{}, wrr{};
  const float per_cut = 1 / cut;
  for (std::size_t i = 0; i < n.padded(); i += kLanes) {
    const Lanes b = load_lanes(&n.parallax[i]), s = load_lanes(&n.along[i]),
                q = load_lanes(&n.polarity[i]);
    const Lanes r =
        load_lanes(&n.across[i]) + b * p.change - p.offset - p.tilt * s - p.hysteresis * q;
    const Lanes u = r * per_cut;
    Lanes v = 1 - u * u;
    v = v > 0 ? v : Lanes{};
    const Lanes w = v * v * q * q;  // q is 0 behind the end
    const Lanes ws = w * s, wq = w * q, wb = w * b, wr = w * r;
    w_ += w, ws_ += ws, wq_ += wq, wb_ += wb, wr_ += wr;
    wss += ws * s, wsq += ws * q, wsb += ws * b, wsr += wr * s;
    wqq += wq * q, wqb += wq * b, wqr += wr * q;
    wbb += wb * b, wbr += wr * b, wrr += wr * r;
  }
  Normal normal;
  // Columns of the design: -1, -s, -p, B.
  normal.a[0] = {sum_of(w_)};
  normal.a[1] = {sum_of(ws_), sum_of(wss)};
  normal.a[2] = {sum_of(wq_), sum_of(wsq), sum_of(wqq)};
  normal.a[3] = {-sum_of(wb_), -sum_of(wsb), -sum_of(wqb), sum_of(wbb)};
  normal.b = {-sum_of(wr_), -sum_of(wsr), -sum_of(wqr), sum_of(wbr)};
  normal.squares = sum_of(wrr);
  normal.weights = normal.a[0][0];
  return normal;
}

/// Robust scale from the weighted residuals of the previous iteration, without sorting.
float scale_of(const Normal& normal) {
  const double variance = kBiweightVariance * normal.squares / std::max(normal.weights, 1.0);
  return std::max(kMinScale_px, static_cast<float>(std::sqrt(variance)));
}

/// Variance of the residuals, from which sigma follows.
double variance_of(const Normal& normal) {
  return normal.squares / std::max(normal.weights - kUnknowns, 1.0);
}

/// Adds a Gaussian prior around 0; sigma 0 fixes the unknown at 0.
void add_prior(Normal& normal, std::size_t k, double prior_sigma, double value, double variance) {
  if (prior_sigma > 0) {
    normal.a[k][k] += variance / (prior_sigma * prior_sigma);
    normal.b[k] += variance / (prior_sigma * prior_sigma) * value;
    return;
  }
  for (std::size_t j = 0; j < k; ++j) normal.a[k][j] = 0;
  for (std::size_t i = k + 1; i < kUnknowns; ++i) normal.a[i][k] = 0;
  normal.a[k][k] = 1;
  normal.b[k] = 0;
}

void add_priors(Normal& normal, const Parameters& p, const RegressionOptions& options,
                double variance) {
  add_prior(normal, 0, options.offset_sigma_px, static_cast<double>(p.offset), variance);
  add_prior(normal, 1, options.tilt_sigma, static_cast<double>(p.tilt), variance);
  add_prior(normal, 2, options.hysteresis_sigma_px, static_cast<double>(p.hysteresis), variance);
}

struct Solution {
  bool ok = false;
  std::array<double, kUnknowns> x{};
  double variance = 0;  ///< of the last unknown, the others marginalised: (A^-1)_33
};

/// L D L^T.
Solution solve(const Normal& normal) {
  auto l = normal.a;
  std::array<double, kUnknowns> d{};
  Solution s;
  for (std::size_t i = 0; i < kUnknowns; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      for (std::size_t k = 0; k < j; ++k) l[i][j] -= l[i][k] * l[j][k] * d[k];
      l[i][j] /= d[j];
    }
    d[i] = l[i][i];
    for (std::size_t k = 0; k < i; ++k) d[i] -= l[i][k] * l[i][k] * d[k];
    if (!(d[i] > 1e-9)) return s;
  }
  s.x = normal.b;
  for (std::size_t i = 0; i < kUnknowns; ++i)
    for (std::size_t k = 0; k < i; ++k) s.x[i] -= l[i][k] * s.x[k];
  for (std::size_t i = 0; i < kUnknowns; ++i) s.x[i] /= d[i];
  for (std::size_t i = kUnknowns; i-- > 0;)
    for (std::size_t k = i + 1; k < kUnknowns; ++k) s.x[i] -= l[k][i] * s.x[k];
  s.ok = true;
  s.variance = 1 / d[kUnknowns - 1];
  return s;
}

}  // namespace

RegressionResult regress(const RayNeighbourhood& near, const RegressionOptions& options,
                         double prior_sigma) {
  RegressionResult result;
  if (near.count < kMinEvents) return result;
  Parameters p;
  const float widest = static_cast<float>(options.window.radius_px);
  Normal normal;
  Solution solution;
  for (int i = 0; i < options.iterations; ++i) {
    const float scale = i == 0 ? widest / kBiweightCutoff : scale_of(normal);
    result.cut_px = std::min(kBiweightCutoff * scale, widest);
    const double variance = static_cast<double>(scale) * static_cast<double>(scale);
    const double noise = i == 0 ? variance : variance_of(normal);
    normal = accumulate(near, p, result.cut_px);
    add_priors(normal, p, options, variance);
    add_prior(normal, 3, prior_sigma, static_cast<double>(p.change), noise);
    solution = solve(normal);
    if (!solution.ok) return result;
    p.offset -= static_cast<float>(solution.x[0]);
    p.tilt -= static_cast<float>(solution.x[1]);
    p.hysteresis -= static_cast<float>(solution.x[2]);
    p.change -= static_cast<float>(solution.x[3]);
    double decrease = 0;
    for (std::size_t k = 0; k < kUnknowns; ++k) decrease += solution.x[k] * normal.b[k];
    if (i > 0 && decrease < options.converged * variance) break;
  }
  const double residual_variance = variance_of(normal);
  result.ok = true;
  result.change = p.change;
  result.offset_px = p.offset;
  result.tilt = p.tilt;
  result.hysteresis_px = p.hysteresis;
  result.residual_px = static_cast<float>(std::sqrt(residual_variance));
  result.sigma = static_cast<float>(std::sqrt(residual_variance * solution.variance));
  result.support = static_cast<float>(normal.weights);
  return result;
}

void append_events(const RayNeighbourhood& near, const RegressionResult& result,
                   EdgelEvents& events) {
  for (std::size_t i = 0; i < near.count; ++i) {
    const float residual = near.across[i] + near.parallax[i] * result.change - result.offset_px -
                           result.tilt * near.along[i] - result.hysteresis_px * near.polarity[i];
    const float u = residual / result.cut_px;
    if (!(u * u < 1)) continue;
    events.event.push_back(near.event[i]);
    events.weight.push_back((1 - u * u) * (1 - u * u));
  }
}

Edgel moved(const Edgel& edge, const RegressionResult& result) {
  Edgel next;
  next.pixel = edge.pixel + result.offset_px * edge.normal;
  next.normal = (edge.normal - result.tilt * edge.tangent()).normalized();
  next.inverse_depth = edge.inverse_depth + result.change;
  return next;
}

}  // namespace saccade
