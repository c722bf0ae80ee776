#include "estimator/reconstruction/equations/intensity_system.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "core/check.h"
#include "core/process/parallel.h"

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

Corners corners_of(const std::array<std::uint16_t, 4>& steps) {
  using Words = std::uint64_t __attribute__((vector_size(2 * sizeof(std::uint64_t))));
  using Halves = std::uint16_t __attribute__((vector_size(8 * sizeof(std::uint16_t))));
  using Integers = std::int32_t __attribute__((vector_size(4 * sizeof(std::int32_t))));
  std::uint64_t word = 0;
  std::memcpy(&word, steps.data(), sizeof word);
  const auto halves = reinterpret_cast<Halves>(Words{word, 0});
  // Zeros as upper halves: the compiler would convert half a register in two steps.
  return __builtin_convertvector(reinterpret_cast<Integers>(__builtin_shufflevector(
                                     halves, Halves{}, 0, 8, 1, 9, 2, 10, 3, 11)),
                                 Corners);
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

/// The sum of the inverses of the diagonal and of the coarse grid.
class Preconditioner {
 public:
  Preconditioner(const std::vector<float>& diagonal, const CoarseGrid& grid,
                 std::span<const Stiffness> stiffness, float level_weight)
      : coarse_(grid, stiffness, static_cast<double>(level_weight)) {
    const double mean = std::accumulate(diagonal.begin(), diagonal.end(), 0.0) /
                        static_cast<double>(diagonal.size());
    const auto least = static_cast<float>(1e-6 * mean);  // of pixels that nothing constrains
    for (const float d : diagonal) over_diagonal_.push_back(1 / std::max(d, least));
  }

  void apply(const std::vector<float>& r, std::vector<float>& z) const {
    for (std::size_t i = 0; i < r.size(); ++i) z[i] = over_diagonal_[i] * r[i];
    coarse_.add(r, z);
  }

 private:
  std::vector<float> over_diagonal_;
  CoarseImage coarse_;
};

/// Four weights in whole steps, and their sum.
struct CornerSteps {
  Corners corners;
  float sum;
};

/// The weights of an observation's pixels as whole steps of its run, of which one is 1 / 65535 of the largest weight: what is
/// stored of an observation (Entry) is what it counts for everywhere. So the factors of a run sum to one exactly, and the
/// constant of the image costs nothing.
class WeightSteps {
 public:
  explicit WeightSteps(std::span<const GridObservation> observations) {
    float largest = 0;
    for (const GridObservation& o : observations) largest = std::max(largest, o.weight);
    weight_ = largest / kMost;
    per_weight_ = largest > 0 ? kMost / largest : 0;
  }
  /// At least one for the nearest pixel where the observation has a weight.
  [[nodiscard]] CornerSteps of(const GridObservation& o) const {
    using Integers = std::int32_t __attribute__((vector_size(4 * sizeof(std::int32_t))));
    constexpr float kLeast = 4;
    const float steps = o.weight > 0 ? std::max(o.weight * per_weight_, kLeast) : 0;
    Corners corners;
    std::memcpy(&corners, o.point.weight.data(), sizeof corners);
    corners =
        __builtin_convertvector(__builtin_convertvector(steps * corners + 0.5F, Integers), Corners);
    return {corners, corners[0] + corners[1] + (corners[2] + corners[3])};
  }
  /// Of one step.
  [[nodiscard]] float weight() const { return weight_; }

 private:
  static constexpr float kMost = 65535;
  float weight_, per_weight_;
};

/// Means over the observations of a run.
struct RunMoments {
  double steps = 0;  ///< sum of their weights
  float log_intensity = 0;
  float xx = 0, xy = 0, yy = 0;  ///< covariance of the reprojections [px^2]

  RunMoments(std::span<const GridObservation> observations, const WeightSteps& weights) {
    const GridObservation& head = observations.front();
    double l = 0, x = 0, y = 0, x2 = 0, y2 = 0, x_y = 0;
    for (const GridObservation& o : observations) {
      const auto w = static_cast<double>(weights.of(o).sum);
      const auto dx = static_cast<double>(o.x - head.x), dy = static_cast<double>(o.y - head.y);
      steps += w;
      l += w * static_cast<double>(o.log_intensity - head.log_intensity);
      x += w * dx;
      y += w * dy;
      x2 += w * dx * dx;
      y2 += w * dy * dy;
      x_y += w * dx * dy;
    }
    if (!(steps > 0)) return;
    const double over = 1 / steps;
    x *= over;
    y *= over;
    log_intensity = head.log_intensity + static_cast<float>(l * over);
    xx = std::max(static_cast<float>(x2 * over - x * x), 0.0F);
    xy = static_cast<float>(x_y * over - x * y);
    yy = std::max(static_cast<float>(y2 * over - y * y), 0.0F);
  }
};

}  // namespace

IntensitySystem::IntensitySystem(int width, int height, bool wraps, std::size_t parts)
    : width_(width),
      height_(height),
      columns_(wraps ? width + 1 : width),
      rows_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(height)),
      coarse_(width, height, wraps),
      smoothness_(coarse_.cells()),
      parts_(parts) {
  SACCADE_CHECK(width > (wraps ? 2 : 1) && height > 1 && parts > 0);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < columns_; ++x)
      coarse_cell_.push_back(
          static_cast<std::uint32_t>(coarse_.cell_of(x < width ? x : x - width, y)));
  for (Part& part : parts_) {
    part.cells.resize(rows_.size());
    part.stiffness.resize(coarse_.cells());
  }
}

void IntensitySystem::clear() {
  std::fill(rows_.begin(), rows_.end(), std::array<float, kNeighbours>{});
  for (Part& part : parts_) {
    const auto cells = part.cells.begin();
    std::fill(cells + static_cast<std::ptrdiff_t>(part.first),
              cells + static_cast<std::ptrdiff_t>(part.end), Lanes{});
    part.entries.clear();
    part.runs.clear();
    part.first = part.end = 0;
    std::fill(part.stiffness.begin(), part.stiffness.end(), Stiffness{});
  }
  std::fill(smoothness_.begin(), smoothness_.end(), Stiffness{});
}

void IntensitySystem::add_run(std::size_t part, std::span<const GridObservation> observations) {
  const WeightSteps weights(observations);
  const RunMoments moments(observations, weights);
  if (!(moments.steps > 0)) return;
  Part& own = parts_[part];
  if (own.entries.empty()) own.first = rows_.size();
  std::uint32_t count = 0;
  for (const GridObservation& o : observations) {
    const auto [f, steps] = weights.of(o);
    if (steps == 0) continue;
    Entry& entry = own.entries.emplace_back();
    entry.index = unrolled(o.point.index[0]);
    for (std::size_t k = 0; k < 4; ++k) entry.steps[k] = static_cast<std::uint16_t>(f[k]);
    const Lanes row = {f[0], f[1], f[2], f[3], steps * (o.log_intensity - moments.log_intensity)};
    const auto cell = static_cast<std::size_t>(entry.index);
    own.cells[cell] += products(weights.weight() / steps, row);
    own.first = std::min(own.first, cell);
    own.end = std::max(own.end, cell + 1);
    // The run's observations, taken together, know the slope along itself by their covariance.
    const float weight = weights.weight() * steps;
    own.stiffness[coarse_cell_[cell]] +=
        {weight * moments.xx, weight * moments.xy, weight * moments.yy};
    ++count;
  }
  own.runs.push_back({count, weights.weight() * static_cast<float>(moments.steps),
                      static_cast<float>(1 / moments.steps)});
}

void IntensitySystem::add_smoothness_term(int i, int j, float weight) {
  const int lower = std::min(i, j);
  const int upper = std::max(i, j);
  const bool is_at_seam = wraps() && upper - lower == width_ - 1;
  const int first = unrolled(is_at_seam ? upper : lower);
  const int second = is_at_seam ? first + 1 : unrolled(upper);
  rows_[static_cast<std::size_t>(first)][0] += weight;
  rows_[static_cast<std::size_t>(second)][0] += weight;
  const bool is_beside = second == first + 1;
  rows_[static_cast<std::size_t>(first)][is_beside ? 1 : 3] -= weight;
  Stiffness& stiffness = smoothness_[coarse_cell_[static_cast<std::size_t>(first)]];
  (is_beside ? stiffness.xx : stiffness.yy) += weight;
}

std::vector<Stiffness> IntensitySystem::stiffness() const {
  std::vector<Stiffness> sum = smoothness_;
  for (const Part& part : parts_)
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += part.stiffness[i];
  return sum;
}

IntensitySystem::Stencil IntensitySystem::stencil(std::vector<float>& right_side) const {
  Stencil stencil;
  for (std::size_t k = 0; k < kNeighbours; ++k) {
    stencil[k].resize(rows_.size());
    for (std::size_t i = 0; i < rows_.size(); ++i) stencil[k][i] = rows_[i][k];
  }
  const auto width = static_cast<std::size_t>(columns_);
  // Not of the repeated column.
  for (std::size_t i = 0; i < rows_.size(); ++i)
    if (i % width < static_cast<std::size_t>(width_)) stencil[0][i] += level_weight_;
  const std::array<std::size_t, 4> corner = {0, 1, width, width + 1};
  for (const Part& part : parts_)
    for (std::size_t i = part.first; i < part.end; ++i) {
      const Lanes& cell = part.cells[i];
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
                               std::vector<float>& y, PartSums& sums) const {
  if (!wraps()) {
    multiply_unrolled(stencil, x, y, sums);
    return;
  }
  std::vector<float> product(rows_.size());
  multiply_unrolled(stencil, unrolled(x), product, sums);
  y = folded(product);
}

void IntensitySystem::multiply_unrolled(const Stencil& stencil, const std::vector<float>& x,
                                        std::vector<float>& y, PartSums& sums) const {
  parallel_for(parts_.size(), [&](std::size_t k) { multiply_runs(parts_[k], x, sums[k]); });
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
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    float* target = y.data() + parts_[k].first;
    for (const Corners& sum : sums[k]) {
      target[0] -= sum[0];
      target[1] -= sum[1];
      target[width] -= sum[2];
      target[width + 1] -= sum[3];
      ++target;
    }
  }
}

void IntensitySystem::multiply_runs(const Part& part, const std::vector<float>& x,
                                    std::vector<Corners>& all_sums) const {
  if (part.runs.empty()) return;
  all_sums.assign(part.end - part.first, Corners{});
  Corners* sums = all_sums.data();
  const float* from = x.data();
  const float* below = from + columns_;
  const auto first = static_cast<std::ptrdiff_t>(part.first);
  const Entry* entry = part.entries.data();
  for (const Run& run : part.runs) {
    const std::span<const Entry> entries(entry, run.entries);
    entry += run.entries;
    Corners along{};
    for (const auto& [i, steps] : entries)
      along += corners_of(steps) * corners_at(from + i, below + i);
    const float mean =
        (along[0] + along[1] + (along[2] + along[3])) * run.weight * run.unit * run.unit;
    for (const auto& [i, steps] : entries) sums[i - first] += mean * corners_of(steps);
  }
}

GridSolution IntensitySystem::solve(int iterations, double tolerance, const ImageF& start) const {
  std::vector<float> right_side(rows_.size());
  const Stencil stencil = this->stencil(right_side);
  std::vector<float> r = folded(right_side);
  const std::size_t n = r.size();
  PartSums sums(parts_.size());
  std::vector<float> x(n, 0), z(n), p, q(n);
  const Preconditioner preconditioner(folded(stencil[0]), coarse_, stiffness(), level_weight_);
  GridSolution solution{ImageF(width_, height_), 0, 0};
  preconditioner.apply(r, z);
  const double full = std::max(dot(r, z), 1e-30);
  if (!start.empty()) {
    x.assign(start.pixels().begin(), start.pixels().end());
    multiply(stencil, x, q, sums);
    for (std::size_t i = 0; i < n; ++i) r[i] -= q[i];
    preconditioner.apply(r, z);
  }
  p = z;
  double rz = dot(r, z);
  while (solution.iterations < iterations && rz > tolerance * tolerance * full) {
    multiply(stencil, p, q, sums);
    const double curvature = dot(p, q);
    if (!(curvature > 0)) break;  // as precise as single precision allows
    const auto alpha = static_cast<float>(rz / curvature);
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
