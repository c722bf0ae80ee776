#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/image.h"
#include "estimator/lanes.h"

namespace saccade {

/// A sub-pixel position on a grid of unknowns: the value there is the weighted mean of four of them
/// (thesis A.2). Weights sum to one.
struct GridPoint {
  std::array<int, 4> index;
  std::array<float, 4> weight;
};

/// An observation of the image between pixels of the grid.
struct GridObservation {
  GridPoint point;
  float log_intensity, weight;
};

struct GridSolution {
  ImageF image;         ///< up to a constant
  int iterations = 0;   ///< of conjugate gradients
  double residual = 0;  ///< |r| / |b| in the preconditioner's norm
};

/// Weighted linear least squares over the pixels of an image I and one offset c per event run:
///   min over I, c of  sum_k w_k (I(x_k) - c_run(k) - l_k)^2
/// which leaves a constant of the image undetermined: it stays that of the first guess.
/// The offsets are eliminated (Schur complement): with m_r the weighted mean of a run's rows and n_r
/// the sum of its weights, the normal matrix is that of the pixels (a stencil) minus
/// sum_r n_r m_r m_r^T. Solved by conjugate gradients, preconditioned in the cosine domain: waves
/// shorter than the runs are observed by every observation, longer ones by their slope only. An image
/// that wraps is unrolled by repeating its first column behind the last one.
class IntensitySystem {
 public:
  /// `wraps`: the last column is the first one's neighbour.
  IntensitySystem(int width, int height, bool wraps = false);

  /// Removes all terms, but keeps the memory.
  void clear();

  /// Allocates memory for so many observations.
  void reserve(std::size_t observations) { entries_.reserve(observations); }

  /// The observations of one event run. A point's four pixels are a square, the first its upper left
  /// corner; it may lie across the seam of an image that wraps.
  void add_run(std::span<const GridObservation> observations);

  /// Adds w (I(j) - I(i))^2 of two neighbours.
  void add_smoothness_term(int i, int j, float weight);

  /// Ends when the relative residual is below `tolerance`. `start`: first guess; empty: 0.
  [[nodiscard]] GridSolution solve(int iterations, double tolerance,
                                   const ImageF& start = {}) const;

 private:
  static constexpr int kNeighbours = 5;  ///< itself, right, left below, below, right below

  /// The term of an observation in the mean row of its run.
  struct Entry {
    int index;  ///< of the upper left pixel
    std::array<float, 4> factor;
  };
  struct Run {
    std::size_t begin, end;  ///< of its entries
    float weight;
  };

  /// rows_ with the terms of the observations, one neighbour after the other.
  using Stencil = std::array<std::vector<float>, kNeighbours>;

  [[nodiscard]] Stencil stencil(std::vector<float>& right_side) const;
  void multiply(const Stencil& stencil, const std::vector<float>& x, std::vector<float>& y) const;
  void multiply_unrolled(const Stencil& stencil, const std::vector<float>& x,
                         std::vector<float>& y) const;
  [[nodiscard]] double run_variance() const;

  [[nodiscard]] bool wraps() const { return columns_ > width_; }
  /// Index of a pixel in the unrolled image.
  [[nodiscard]] int unrolled(int i) const { return wraps() ? i + i / width_ : i; }
  [[nodiscard]] std::vector<float> unrolled(const std::vector<float>& image) const;
  /// The transpose of it: adds the repeated column to the first one.
  [[nodiscard]] std::vector<float> folded(const std::vector<float>& sums) const;

  int width_, height_;
  int columns_;  ///< of the unrolled image; the members below are of it
  std::vector<std::array<float, kNeighbours>> rows_;
  std::vector<Lanes>
      cells_;  ///< terms of the observations, by the upper left pixel of their square
  std::vector<Entry> entries_;
  std::vector<Run> runs_;
};

}  // namespace saccade
