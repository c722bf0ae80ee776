#include "estimator/depth/ray_regression.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace saccade {
namespace {

constexpr std::size_t kLanes = RayNeighbourhood::kLanes;
constexpr std::size_t kUnknowns = 4;  ///< rho, c, m, h
constexpr std::size_t kTerms = kUnknowns * (kUnknowns + 1) / 2 + kUnknowns + 2;
constexpr std::size_t kMinEvents = 10;
constexpr float kTukey = 4.685F;  ///< 95 % efficient on Gaussian residuals
constexpr float kMinScale_px = 0.1F;
constexpr double kSlack_px = 1;
/// sigma^2 / (sum w r^2 / sum w) of Gaussian residuals under the biweight at kTukey sigma.
constexpr double kWeightedVariance = 1.29;

using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Vector = Eigen::Matrix<double, kUnknowns, 1>;

/// Sums over the events, each lane for itself, so that they vectorise without reordering.
struct Sums {
  std::array<std::array<float, kLanes>, kTerms> lanes{};

  [[nodiscard]] double operator[](std::size_t term) const {
    double sum = 0;
    for (const float lane : lanes[term]) sum += static_cast<double>(lane);
    return sum;
  }
};

struct Normal {
  Matrix a = Matrix::Zero();
  Vector b = Vector::Zero();
  double squares = 0;  ///< sum of w r^2
  double weights = 0;  ///< sum of w
};

struct Parameters {
  float change = 0, offset = 0, tilt = 0, hysteresis = 0;
};

float residual(const RayNeighbourhood& n, std::size_t i, const Parameters& p) {
  return n.across[i] + n.parallax[i] * p.change - p.offset - p.tilt * n.along[i] -
         p.hysteresis * n.polarity[i];
}

/// Weighted normal equations of the residual r = across + B drho - c - m s - h p.
Normal accumulate(const RayNeighbourhood& n, const Parameters& p, float cut) {
  Sums sums;
  const float per_cut = 1 / cut;
  for (std::size_t block = 0; block < n.padded(); block += kLanes)
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::size_t i = block + lane;
      const float b = n.parallax[i], s = n.along[i], q = n.polarity[i];
      const float r = n.across[i] + b * p.change - p.offset - p.tilt * s - p.hysteresis * q;
      const float u = r * per_cut;
      const float v = std::max(0.F, 1 - u * u);
      const float w = v * v * q * q;  // q is 0 behind the end
      const float wb = w * b, ws = w * s, wq = w * q, wr = w * r;
      const float terms[kTerms] = {wb * b, wb, wb * s, wb * q, w,      ws,     wq,     ws * s,
                                   ws * q, w,  wr * b, wr,     wr * s, wr * q, wr * r, w};
      for (std::size_t k = 0; k < kTerms; ++k) sums.lanes[k][lane] += terms[k];
    }
  Normal normal;
  // Columns of the design: B, -1, -s, -p.
  normal.a << sums[0], -sums[1], -sums[2], -sums[3],  //
      -sums[1], sums[4], sums[5], sums[6],            //
      -sums[2], sums[5], sums[7], sums[8],            //
      -sums[3], sums[6], sums[8], sums[9];
  normal.b << sums[10], -sums[11], -sums[12], -sums[13];
  normal.squares = sums[14];
  normal.weights = sums[15];
  return normal;
}

/// 1.4826 median |r|.
float robust_scale(const RayNeighbourhood& n, const Parameters& p, std::vector<float>& scratch) {
  scratch.resize(n.count);
  for (std::size_t i = 0; i < n.count; ++i) scratch[i] = std::abs(residual(n, i, p));
  const auto middle = scratch.begin() + static_cast<std::ptrdiff_t>(n.count / 2);
  std::nth_element(scratch.begin(), middle, scratch.end());
  return std::max(kMinScale_px, 1.4826F * *middle);
}

/// The same from the weighted residuals of the last iteration, without sorting.
float weighted_scale(const Normal& normal) {
  const double variance = kWeightedVariance * normal.squares / std::max(normal.weights, 1.0);
  return std::max(kMinScale_px, static_cast<float>(std::sqrt(variance)));
}

/// Adds a Gaussian prior around 0, or holds the unknown at 0.
void add_prior(Normal& normal, Eigen::Index k, double deviation, double value, double variance) {
  if (deviation > 0) {
    normal.a(k, k) += variance / (deviation * deviation);
    normal.b(k) += variance / (deviation * deviation) * value;
    return;
  }
  normal.a.row(k).setZero();
  normal.a.col(k).setZero();
  normal.a(k, k) = 1;
  normal.b(k) = 0;
}

void add_priors(Normal& normal, const Parameters& p, const RegressionOptions& options,
                double variance) {
  add_prior(normal, 1, options.offset_prior_px, static_cast<double>(p.offset), variance);
  add_prior(normal, 2, options.tilt_prior, static_cast<double>(p.tilt), variance);
  add_prior(normal, 3, options.hysteresis_prior_px, static_cast<double>(p.hysteresis), variance);
}

/// Whether a pixel that the edge passes over gets brighter: the edge moves against its normal.
bool is_rising(const EventRays::Slab& slab, const Eigen::Vector3f& projected, const RayEdge& edge) {
  const float rho = edge.inverse_depth;
  const Eigen::Vector2f at = projected.hnormalized();
  const Eigen::Vector3f rate = slab.project_rate(edge.pixel, rho);
  const Eigen::Vector2f motion = (rate.head<2>() - at * rate.z()) / projected.z();
  const Eigen::Vector2f beside = slab.project(edge.pixel + edge.tangent(), rho).hnormalized();
  const Eigen::Vector2f along = beside - at;
  return along.y() * motion.x() - along.x() * motion.y() < 0;
}

/// Those of events [begin, end) that pass near the edge. Without branches: which do is random.
void gather_run(const EventRays& rays, std::uint32_t begin, std::uint32_t end, const RayEdge& edge,
                const RegressionOptions& options, float polarity, RayNeighbourhood& near) {
  near.reserve(end - begin);
  const float rho = edge.inverse_depth;
  const float nx = edge.normal.x(), ny = edge.normal.y();
  const float ex = edge.pixel.x(), ey = edge.pixel.y();
  const auto radius = static_cast<float>(options.radius_px);
  const auto half_length = static_cast<float>(options.half_length_px);
  std::size_t count = near.count;
  for (std::uint32_t i = begin; i < end; ++i) {
    const RayLine& line = rays.line[i];
    const float dx = line.ax + line.bx * rho - ex;
    const float dy = line.ay + line.by * rho - ey;
    const float across = nx * dx + ny * dy;
    const float along = nx * dy - ny * dx;
    near.event[count] = i;
    near.across[count] = across;
    near.along[count] = along;
    near.parallax[count] = nx * line.bx + ny * line.by;
    near.polarity[count] = polarity;
    const bool is_near = (std::abs(across) <= radius) & (std::abs(along) <= half_length);
    count += is_near ? 1 : 0;
  }
  near.count = count;
}

}  // namespace

void RayNeighbourhood::reserve(std::size_t more) {
  const std::size_t size = count + more + kLanes;
  if (event.size() >= size) return;
  event.resize(2 * size);
  for (auto* array : {&across, &along, &parallax, &polarity}) array->resize(2 * size);
}

void RayNeighbourhood::pad() {
  reserve(0);
  for (std::size_t i = count; i < padded(); ++i)
    for (auto* array : {&across, &along, &parallax, &polarity}) (*array)[i] = 0;
}

void gather_rays(const EventRays& rays, const SlabSteps& slabs, const RayEdge& edge,
                 const RegressionOptions& options, RayNeighbourhood& near) {
  // The cells are those of the sensor at half time; the slack is for the motion within the slab.
  const auto reach =
      static_cast<float>(std::hypot(options.radius_px, options.half_length_px) + kSlack_px);
  near.count = 0;
  for (int k = slabs.first; k < slabs.last; k += slabs.stride) {
    const EventRays::Slab& slab = rays.slabs()[static_cast<std::size_t>(k)];
    const Eigen::Vector3f h = slab.project(edge.pixel, edge.inverse_depth);
    if (!(h.z() > 0)) continue;
    const Eigen::Vector2f at = h.hnormalized();
    if (!rays.on_grid(at.x(), at.y())) continue;
    const bool is_on = is_rising(slab, h, edge);
    const int left = rays.column_of(at.x() - reach), right = rays.column_of(at.x() + reach);
    const int top = rays.row_of(at.y() - reach), bottom = rays.row_of(at.y() + reach);
    for (int row = top; row <= bottom; ++row)
      gather_run(rays, rays.cell_begin(k, is_on, left, row),
                 rays.cell_begin(k, is_on, right + 1, row), edge, options, is_on ? 1.F : -1.F,
                 near);
  }
  near.pad();
}

RegressionResult regress(const RayNeighbourhood& near, const RegressionOptions& options) {
  RegressionResult result;
  if (near.count < kMinEvents) return result;
  Parameters p;
  std::vector<float> scratch;
  const float widest = static_cast<float>(options.radius_px);
  Normal normal;
  Eigen::LDLT<Matrix> solver;
  double variance = 1;
  float cut = widest;
  for (int i = 0; i < options.iterations; ++i) {
    const float scale = i == 0 ? robust_scale(near, p, scratch) : weighted_scale(normal);
    cut = std::min(kTukey * scale, widest);
    variance = static_cast<double>(scale) * static_cast<double>(scale);
    normal = accumulate(near, p, cut);
    add_priors(normal, p, options, variance);
    solver.compute(normal.a);
    if (solver.info() != Eigen::Success || !(solver.vectorD().minCoeff() > 1e-9)) return result;
    const Vector step = solver.solve(normal.b);
    p.change -= static_cast<float>(step(0));
    p.offset -= static_cast<float>(step(1));
    p.tilt -= static_cast<float>(step(2));
    p.hysteresis -= static_cast<float>(step(3));
  }
  const double squares = normal.squares / std::max(normal.weights - kUnknowns, 1.0);
  const Vector information = solver.solve(Vector::Unit(0));
  result.ok = true;
  result.change = p.change;
  result.offset_px = p.offset;
  result.tilt = p.tilt;
  result.hysteresis_px = p.hysteresis;
  result.residual_px = static_cast<float>(std::sqrt(squares));
  result.sigma = static_cast<float>(std::sqrt(squares * information(0)));
  result.cut_px = cut;
  result.support = static_cast<float>(normal.weights);
  return result;
}

std::vector<float> weights_of(const RayNeighbourhood& near, const RegressionResult& result) {
  const Parameters p{result.change, result.offset_px, result.tilt, result.hysteresis_px};
  std::vector<float> weights(near.count);
  for (std::size_t i = 0; i < near.count; ++i) {
    const float u = residual(near, i, p) / result.cut_px;
    const float v = std::max(0.F, 1 - u * u);
    weights[i] = v * v;
  }
  return weights;
}

RayEdge moved(const RayEdge& edge, const RegressionResult& result) {
  RayEdge next;
  next.pixel = edge.pixel + result.offset_px * edge.normal;
  next.normal = (edge.normal - result.tilt * edge.tangent()).normalized();
  next.inverse_depth = edge.inverse_depth + result.change;
  return next;
}

}  // namespace saccade
