#include "estimator/reconstruction/equations/intensity_system.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "core/check.h"
#include "estimator/reconstruction/gradient/poisson.h"

namespace saccade {
namespace {

/// The terms of an observation for its square of four pixels, whose corners are 0 upper left, 1 upper right, 2
/// lower left and 3 lower right, all at once: the products of the corners' weights, then those with
/// the log intensity (4), each times the weight of the observation. Lane 5 is 0.
Lanes products(float weight, const Lanes& row) {
  const Lanes one =
      __builtin_shufflevector(row, row, 0, 0, 0, 0, 1, 1, 1, 2, 2, 3, 0, 1, 2, 3, 5, 5);
  const Lanes other =
      __builtin_shufflevector(row, row, 0, 1, 2, 3, 1, 2, 3, 2, 3, 3, 4, 4, 4, 4, 5, 5);
  return weight * one * other;
}
constexpr std::size_t kProducts = 10;
/// Where a product belongs: the corner of one, whose neighbour the other is.
constexpr std::array<std::size_t, kProducts> kCorner = {0, 0, 0, 0, 1, 1, 1, 2, 2, 3};
constexpr std::array<std::size_t, kProducts> kNeighbour = {0, 1, 3, 4, 0, 2, 3, 0, 1, 0};

/// Four values of a square.
using Corners = float __attribute__((vector_size(4 * sizeof(float))));

Corners corners_of(const float* values) {
  Corners corners;
  std::memcpy(&corners, values, sizeof corners);
  return corners;
}

/// Two of them at a time.
Corners corners_at(const float* upper, const float* lower) {
  using Pairs = double __attribute__((vector_size(2 * sizeof(double))));
  double upper_pair = 0, lower_pair = 0;
  std::memcpy(&upper_pair, upper, sizeof upper_pair);
  std::memcpy(&lower_pair, lower, sizeof lower_pair);
  return reinterpret_cast<Corners>(Pairs{upper_pair, lower_pair});
}

double dot(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += static_cast<double>(a[i]) * static_cast<double>(b[i]);
  return sum;
}

/// M^-1 = S^-1 F^-1 S^-1 with S^2 the diagonal and F = q / (q + 1 / variance) in the cosine domain,
/// q the eigenvalue of -lap: the fraction of a wave's power that varies along a run.
class CosinePreconditioner {
 public:
  CosinePreconditioner(int width, int height, const std::vector<float>& diagonal, double variance)
      : buffer_(width, height) {
    const double mean = std::accumulate(diagonal.begin(), diagonal.end(), 0.0) /
                        static_cast<double>(diagonal.size());
    for (const float d : diagonal)
      scale_.push_back(1 / std::sqrt(std::max(d, static_cast<float>(1e-6 * mean))));
    for (int l = 0; l < height; ++l)
      for (int k = 0; k < width; ++k)
        factor_.push_back(static_cast<float>(
            1 + 1 / (variance * (neumann_eigenvalue(k, l, width, height) + 1e-6))));
  }

  void apply(const std::vector<float>& r, std::vector<float>& z) {
    for (std::size_t i = 0; i < r.size(); ++i) buffer_.pixels()[i] = r[i] * scale_[i];
    cosine_transform(buffer_);
    for (std::size_t i = 0; i < r.size(); ++i) buffer_.pixels()[i] *= factor_[i];
    inverse_cosine_transform(buffer_);
    for (std::size_t i = 0; i < r.size(); ++i) z[i] = buffer_.pixels()[i] * scale_[i];
  }

 private:
  ImageF buffer_;
  std::vector<float> scale_;
  std::vector<float> factor_;
};

}  // namespace

IntensitySystem::IntensitySystem(int width, int height, bool wraps)
    : width_(width),
      height_(height),
      columns_(wraps ? width + 1 : width),
      rows_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(height)),
      cells_(rows_.size()) {
  SACCADE_CHECK(width > (wraps ? 2 : 1) && height > 1);
}

void IntensitySystem::clear() {
  std::fill(rows_.begin(), rows_.end(), std::array<float, kNeighbours>{});
  std::fill(cells_.begin(), cells_.end(), Lanes{});
  entries_.clear();
  runs_.clear();
}

void IntensitySystem::add_run(std::span<const GridObservation> observations) {
  double weight = 0, log_intensity = 0;
  for (const GridObservation& o : observations) {
    weight += static_cast<double>(o.weight);
    log_intensity +=
        static_cast<double>(o.weight * (o.log_intensity - observations.front().log_intensity));
  }
  if (!(weight > 0)) return;
  const float mean =
      observations.front().log_intensity + static_cast<float>(log_intensity / weight);
  const auto scale = static_cast<float>(1 / weight);
  const std::size_t begin = entries_.size();
  for (const GridObservation& o : observations) {
    const auto& f = o.point.weight;
    const Lanes row = {f[0], f[1], f[2], f[3], o.log_intensity - mean};
    const int first = unrolled(o.point.index[0]);
    cells_[static_cast<std::size_t>(first)] += products(o.weight, row);
    const float w = o.weight * scale;
    entries_.push_back({first, {w * f[0], w * f[1], w * f[2], w * f[3]}});
  }
  runs_.push_back({begin, entries_.size(), static_cast<float>(weight)});
}

void IntensitySystem::add_smoothness_term(int i, int j, float weight) {
  const int lower = std::min(i, j);
  const int upper = std::max(i, j);
  const bool is_at_seam = wraps() && upper - lower == width_ - 1;
  const int first = unrolled(is_at_seam ? upper : lower);
  const int second = is_at_seam ? first + 1 : unrolled(upper);
  rows_[static_cast<std::size_t>(first)][0] += weight;
  rows_[static_cast<std::size_t>(second)][0] += weight;
  rows_[static_cast<std::size_t>(first)][second == first + 1 ? 1 : 3] -= weight;
}

double IntensitySystem::run_variance() const {
  double sum = 0, weight = 0;
  constexpr std::size_t kEvery = 8;  // a sample of the runs is enough for a mean
  // Columns of a run that crosses the seam continue beyond it.
  const auto continued = [this](int column, int other) {
    if (!wraps() || std::abs(column - other) <= width_ / 2) return column;
    return column < other ? column + width_ : column - width_;
  };
  for (std::size_t t = 0; t < runs_.size(); t += kEvery) {
    const Run& run = runs_[t];
    const int first_column = entries_[run.begin].index % columns_;
    double x = 0, y = 0, square = 0;
    for (std::size_t k = run.begin; k < run.end; ++k) {
      const Entry& entry = entries_[k];
      const double u = continued(entry.index % columns_, first_column);
      const double v = entry.index / columns_;
      const auto f = static_cast<double>(entry.factor[0] + entry.factor[1] + entry.factor[2] +
                                         entry.factor[3]);
      x += f * u;
      y += f * v;
      square += f * (u * u + v * v);
    }
    sum += static_cast<double>(run.weight) * (square - x * x - y * y) / 2;
    weight += static_cast<double>(run.weight);
  }
  return weight > 0 ? std::max(sum / weight, 0.25) : 0.25;
}

IntensitySystem::Stencil IntensitySystem::stencil(std::vector<float>& right_side) const {
  Stencil stencil;
  for (std::size_t k = 0; k < kNeighbours; ++k) {
    stencil[k].resize(rows_.size());
    for (std::size_t i = 0; i < rows_.size(); ++i) stencil[k][i] = rows_[i][k];
  }
  const auto width = static_cast<std::size_t>(columns_);
  const std::array<std::size_t, 4> corner = {0, 1, width, width + 1};
  for (std::size_t i = 0; i + width + 1 < rows_.size(); ++i) {
    const Lanes& cell = cells_[i];
    for (std::size_t p = 0; p < kProducts; ++p)
      stencil[kNeighbour[p]][i + corner[kCorner[p]]] += cell[p];
    for (std::size_t k = 0; k < 4; ++k) right_side[i + corner[k]] += cell[kProducts + k];
  }
  return stencil;
}

std::vector<float> IntensitySystem::unrolled(const std::vector<float>& image) const {
  std::vector<float> result;
  result.reserve(rows_.size());
  for (auto row = image.begin(); row != image.end(); row += width_) {
    result.insert(result.end(), row, row + width_);
    if (wraps()) result.push_back(*row);
  }
  return result;
}

std::vector<float> IntensitySystem::folded(const std::vector<float>& sums) const {
  std::vector<float> result;
  result.reserve(sums.size());
  for (auto row = sums.begin(); row != sums.end(); row += columns_) {
    result.insert(result.end(), row, row + width_);
    if (wraps()) *(result.end() - width_) += row[width_];
  }
  return result;
}

void IntensitySystem::multiply(const Stencil& stencil, const std::vector<float>& x,
                               std::vector<float>& y) const {
  if (!wraps()) {
    multiply_unrolled(stencil, x, y);
    return;
  }
  std::vector<float> sums(rows_.size());
  multiply_unrolled(stencil, unrolled(x), sums);
  y = folded(sums);
}

void IntensitySystem::multiply_unrolled(const Stencil& stencil, const std::vector<float>& x,
                                        std::vector<float>& y) const {
  const auto width = static_cast<std::size_t>(columns_);
  const std::size_t offsets[kNeighbours] = {0, 1, width - 1, width, width + 1};
  for (std::size_t i = 0; i < x.size(); ++i) y[i] = stencil[0][i] * x[i];
  for (std::size_t k = 1; k < kNeighbours; ++k) {
    // What would lie beyond the last row has the factor 0.
    const std::size_t count = x.size() - offsets[k];
    const float* factor = stencil[k].data();
    const float* other = x.data() + offsets[k];
    for (std::size_t i = 0; i < count; ++i) y[i] += factor[i] * other[i];
    float* target = y.data() + offsets[k];
    for (std::size_t i = 0; i < count; ++i) target[i] += factor[i] * x[i];
  }
  const float* from = x.data();
  const float* below = from + width;
  float* to = y.data();
  float* to_below = to + width;
  for (const Run& run : runs_) {
    const std::span<const Entry> entries(entries_.data() + run.begin, run.end - run.begin);
    Corners sums{};
    for (const auto& [i, f] : entries)
      sums += corners_of(f.data()) * corners_at(from + i, below + i);
    const float mean = (sums[0] + sums[1] + (sums[2] + sums[3])) * run.weight;
    for (const auto& [i, f] : entries) {
      to[i] -= f[0] * mean;
      to[i + 1] -= f[1] * mean;
      to_below[i] -= f[2] * mean;
      to_below[i + 1] -= f[3] * mean;
    }
  }
}

GridSolution IntensitySystem::solve(int iterations, double tolerance, const ImageF& start) const {
  std::vector<float> right_side(rows_.size());
  const Stencil stencil = this->stencil(right_side);
  std::vector<float> r = folded(right_side);
  const std::size_t n = r.size();
  std::vector<float> x(n, 0), z(n), p, q(n);
  CosinePreconditioner preconditioner(width_, height_, folded(stencil[0]), run_variance());
  GridSolution solution{ImageF(width_, height_), 0, 0};
  preconditioner.apply(r, z);
  const double full = std::max(dot(r, z), 1e-30);
  if (!start.empty()) {
    x.assign(start.pixels().begin(), start.pixels().end());
    multiply(stencil, x, q);
    for (std::size_t i = 0; i < n; ++i) r[i] -= q[i];
    preconditioner.apply(r, z);
  }
  p = z;
  double rz = dot(r, z);
  while (solution.iterations < iterations && rz > tolerance * tolerance * full) {
    multiply(stencil, p, q);
    const auto alpha = static_cast<float>(rz / dot(p, q));
    for (std::size_t i = 0; i < n; ++i) {
      x[i] += alpha * p[i];
      r[i] -= alpha * q[i];
    }
    preconditioner.apply(r, z);
    const double next = dot(r, z);
    const auto beta = static_cast<float>(next / rz);
    for (std::size_t i = 0; i < n; ++i) p[i] = z[i] + beta * p[i];
    rz = next;
    ++solution.iterations;
  }
  solution.residual = std::sqrt(rz / full);
  std::copy(x.begin(), x.end(), solution.image.pixels().begin());
  return solution;
}

}  // namespace saccade
