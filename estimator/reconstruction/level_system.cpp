#include "estimator/reconstruction/level_system.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include <Eigen/Core>

#include "core/check.h"
#include "estimator/reconstruction/poisson.h"

namespace saccade {
namespace {

double dot(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += static_cast<double>(a[i]) * static_cast<double>(b[i]);
  return sum;
}

/// M^-1 = S^-1 F^-1 S^-1 with S^2 the diagonal and F = q / (q + 1 / variance) in the cosine domain,
/// q the eigenvalue of -lap: the share of a wave's power that varies along a track.
class CosinePreconditioner {
 public:
  CosinePreconditioner(int width, int height, const std::vector<float>& diagonal, double variance)
      : transform_(width, height), buffer_(width, height) {
    const double mean = std::accumulate(diagonal.begin(), diagonal.end(), 0.0) /
                        static_cast<double>(diagonal.size());
    for (const float d : diagonal)
      scale_.push_back(1 / std::sqrt(std::max(d, static_cast<float>(1e-6 * mean))));
    for (int l = 0; l < height; ++l)
      for (int k = 0; k < width; ++k)
        factor_.push_back(
            static_cast<float>(1 + 1 / (variance * (transform_.eigenvalue(k, l) + 1e-6))));
  }

  void apply(const std::vector<float>& r, std::vector<float>& z) {
    for (std::size_t i = 0; i < r.size(); ++i) buffer_.pixels()[i] = r[i] * scale_[i];
    transform_.forward(buffer_);
    for (std::size_t i = 0; i < r.size(); ++i) buffer_.pixels()[i] *= factor_[i];
    transform_.inverse(buffer_);
    for (std::size_t i = 0; i < r.size(); ++i) z[i] = buffer_.pixels()[i] * scale_[i];
  }

 private:
  CosineTransform transform_;
  ImageF buffer_;
  std::vector<float> scale_;
  std::vector<float> factor_;
};

}  // namespace

LevelSystem::LevelSystem(int width, int height)
    : width_(width),
      height_(height),
      rows_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)),
      diagonal_(rows_.size()),
      right_side_(rows_.size()),
      sum_(rows_.size()) {
  SACCADE_CHECK(width > 1 && height > 1);
}

void LevelSystem::clear() {
  std::fill(rows_.begin(), rows_.end(), std::array<float, kNeighbours>{});
  std::fill(diagonal_.begin(), diagonal_.end(), 0.0F);
  std::fill(right_side_.begin(), right_side_.end(), 0.0);
  entries_.clear();
  tracks_.clear();
}

void LevelSystem::begin_track() {
  touched_.clear();
  track_weight_ = track_level_ = 0;
}

void LevelSystem::add(const GridPoint& place, float level, float weight) {
  const auto& i = place.index;
  const auto& f = place.weight;
  const auto row = [&](std::size_t k) -> std::array<float, kNeighbours>& {
    return rows_[static_cast<std::size_t>(i[k])];
  };
  row(0)[0] += weight * f[0] * f[0];
  row(0)[1] += weight * f[0] * f[1];
  row(0)[3] += weight * f[0] * f[2];
  row(0)[4] += weight * f[0] * f[3];
  row(1)[0] += weight * f[1] * f[1];
  row(1)[2] += weight * f[1] * f[2];
  row(1)[3] += weight * f[1] * f[3];
  row(2)[0] += weight * f[2] * f[2];
  row(2)[1] += weight * f[2] * f[3];
  row(3)[0] += weight * f[3] * f[3];
  for (std::size_t k = 0; k < 4; ++k) {
    const float scaled = weight * f[k];
    if (scaled == 0) continue;
    const auto at = static_cast<std::size_t>(i[k]);
    right_side_[at] += static_cast<double>(scaled) * static_cast<double>(level);
    if (sum_[at] == 0) touched_.push_back(i[k]);
    sum_[at] += scaled;
  }
  track_weight_ += static_cast<double>(weight);
  track_level_ += static_cast<double>(weight) * static_cast<double>(level);
}

void LevelSystem::end_track() {
  if (!(track_weight_ > 0)) return;
  const auto scale = static_cast<float>(1 / track_weight_);
  const double mean_level = track_level_ / track_weight_;
  const std::size_t begin = entries_.size();
  for (const int index : touched_) {
    const auto at = static_cast<std::size_t>(index);
    entries_.push_back({index, sum_[at] * scale});
    right_side_[at] -= static_cast<double>(sum_[at]) * mean_level;
    diagonal_[at] += sum_[at] * sum_[at] * scale;
    sum_[at] = 0;
  }
  tracks_.push_back({begin, entries_.size(), static_cast<float>(track_weight_)});
}

void LevelSystem::add_smooth(int i, int j, float weight) {
  const int first = std::min(i, j);
  const int second = std::max(i, j);
  rows_[static_cast<std::size_t>(first)][0] += weight;
  rows_[static_cast<std::size_t>(second)][0] += weight;
  rows_[static_cast<std::size_t>(first)][second == first + 1 ? 1 : 3] -= weight;
}

void LevelSystem::add_value(int i, float value, float weight) {
  rows_[static_cast<std::size_t>(i)][0] += weight;
  right_side_[static_cast<std::size_t>(i)] +=
      static_cast<double>(weight) * static_cast<double>(value);
}

double LevelSystem::track_variance() const {
  double sum = 0, weight = 0;
  constexpr std::size_t kEvery = 8;  // they are many and alike
  for (std::size_t t = 0; t < tracks_.size(); t += kEvery) {
    const Track& track = tracks_[t];
    double x = 0, y = 0, square = 0;
    for (std::size_t k = track.begin; k < track.end; ++k) {
      const double u = entries_[k].index % width_, v = entries_[k].index / width_;
      const auto f = static_cast<double>(entries_[k].factor);
      x += f * u;
      y += f * v;
      square += f * (u * u + v * v);
    }
    sum += static_cast<double>(track.weight) * (square - x * x - y * y) / 2;
    weight += static_cast<double>(track.weight);
  }
  return weight > 0 ? std::max(sum / weight, 0.25) : 0.25;
}

LevelSystem::Stencil LevelSystem::stencil() const {
  Stencil stencil;
  for (std::size_t k = 0; k < kNeighbours; ++k) {
    stencil[k].resize(rows_.size());
    for (std::size_t i = 0; i < rows_.size(); ++i) stencil[k][i] = rows_[i][k];
  }
  return stencil;
}

void LevelSystem::multiply(const Stencil& stencil, const std::vector<float>& x,
                           std::vector<float>& y) const {
  const auto width = static_cast<std::size_t>(width_);
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
  float* to = y.data();
  for (const Track& track : tracks_) {
    const Entry* entries = entries_.data() + track.begin;
    const std::size_t count = track.end - track.begin;
    // Four sums, so that none waits for the one before it.
    Eigen::Array4f sums = Eigen::Array4f::Zero();
    std::size_t k = 0;
    for (; k + 4 <= count; k += 4) {
      const Entry* e = entries + k;
      sums +=
          Eigen::Array4f(e[0].factor, e[1].factor, e[2].factor, e[3].factor) *
          Eigen::Array4f(from[e[0].index], from[e[1].index], from[e[2].index], from[e[3].index]);
    }
    float mean = sums.sum();
    for (; k < count; ++k) mean += entries[k].factor * from[entries[k].index];
    mean *= track.weight;
    for (k = 0; k < count; ++k) to[entries[k].index] -= entries[k].factor * mean;
  }
}

GridSolution LevelSystem::solve(int iterations, double tolerance, const ImageF& start) const {
  const std::size_t n = rows_.size();
  std::vector<float> diagonal(n);
  for (std::size_t i = 0; i < n; ++i) diagonal[i] = rows_[i][0];
  const Stencil stencil = this->stencil();
  CosinePreconditioner preconditioner(width_, height_, diagonal, track_variance());
  GridSolution solution{ImageF(width_, height_), 0, 0};
  std::vector<float> x(n, 0), r(right_side_.begin(), right_side_.end()), z(n), p, q(n);
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
    const auto step = static_cast<float>(rz / dot(p, q));
    for (std::size_t i = 0; i < n; ++i) {
      x[i] += step * p[i];
      r[i] -= step * q[i];
    }
    preconditioner.apply(r, z);
    const double next = dot(r, z);
    const auto turn = static_cast<float>(next / rz);
    for (std::size_t i = 0; i < n; ++i) p[i] = z[i] + turn * p[i];
    rz = next;
    ++solution.iterations;
  }
  solution.residual = std::sqrt(rz / full);
  std::copy(x.begin(), x.end(), solution.image.pixels().begin());
  return solution;
}

}  // namespace saccade
