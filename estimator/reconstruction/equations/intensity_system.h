#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/image.h"
#include "estimator/lanes.h"
#include "estimator/reconstruction/equations/coarse_image.h"

namespace saccade {

/// A sub-pixel position on a grid of unknowns: the value there is the weighted mean of four of them
/// (thesis A.2). Weights sum to one.
struct GridPoint {
  std::array<int, 4> index;
  std::array<float, 4> weight;
};

/// An observation of the image between pixels of the grid.
struct GridObservation {
  float x,
      y;  ///< [px]; in an image that wraps they go on beyond its sides, so that a run's path is continuous
  GridPoint point;
  float log_intensity, weight;
};

struct GridSolution {
  ImageF image;         ///< up to a constant where levels have no weight
  int iterations = 0;   ///< of conjugate gradients
  double residual = 0;  ///< |r| / |b| in the preconditioner's norm
};

/// Values at the four pixels of a square.
using Corners = float __attribute__((vector_size(4 * sizeof(float))));

/// Weighted linear least squares over the pixels of an image I and one offset c per event run:
///   min over I, c of  sum_k w_k (I(x_k) - c_run(k) - l_k)^2
/// which leaves a constant of the image undetermined: without a level weight it stays that of the first guess.
/// The offsets are eliminated (Schur complement): with m_r the weighted mean of a run's rows and n_r
/// the sum of its weights, the normal matrix is that of the pixels (a stencil) minus
/// sum_r n_r m_r m_r^T. Solved by conjugate gradients. Of waves shorter than the runs every observation tells
/// the value, of longer ones a run tells the slope along itself only, as a diffusion whose tensor is the
/// covariance of its reprojections. The preconditioner is the sum of the inverses of both: of the diagonal,
/// and of that diffusion (with the smoothness) on a coarse grid (coarse_image.h). An image
/// that wraps is unrolled by repeating its first column behind the last one.
class IntensitySystem {
 public:
  /// `wraps`: the last column is the first one's neighbour. `parts` of the runs, which threads add and
  /// multiply by themselves; their sums are added up in the order of the parts.
  IntensitySystem(int width, int height, bool wraps = false, std::size_t parts = 1);

  /// Removes all terms but the level weight, and keeps the memory.
  void clear();

  /// Allocates memory for so many observations of a part.
  void reserve(std::size_t part, std::size_t observations) {
    parts_[part].entries.reserve(observations);
  }

  /// The observations of one event run. A point's four pixels are a square, the first its upper left
  /// corner; it may lie across the seam of an image that wraps. One thread for each part.
  void add_run(std::size_t part, std::span<const GridObservation> observations);

  /// Adds w I^2 of every pixel; replaces what was added before.
  void set_level_weight(float weight) { level_weight_ = weight; }

  /// Adds w (I(j) - I(i))^2 of two neighbours.
  void add_smoothness_term(int i, int j, float weight);

  /// Ends when the relative residual is below `tolerance`, which single precision reaches down to about 1e-4. `start`: first guess; empty: 0.
  [[nodiscard]] GridSolution solve(int iterations, double tolerance,
                                   const ImageF& start = {}) const;

 private:
  static constexpr int kNeighbours = 5;  ///< itself, right, left below, below, right below

  /// The term of an observation in the mean row of its run.
  struct Entry {
    int index;                           ///< of the upper left pixel
    std::array<std::uint16_t, 4> steps;  ///< factors in units of the run: less to read than floats
  };
  struct Run {
    std::uint32_t entries;
    float weight;
    float unit;  ///< of its entries' steps
  };
  struct Part {
    std::vector<Lanes>
        cells;  ///< terms of the observations, by the upper left pixel of their square
    std::vector<Entry> entries;  ///< of one run after the other
    std::vector<Run> runs;
    /// Upper left pixels of the entries, [first, end).
    std::size_t first = 0, end = 0;
    std::vector<Stiffness> stiffness;  ///< of the coarse grid's cells
  };

  /// rows_ with the terms of the observations, one neighbour after the other.
  using Stencil = std::array<std::vector<float>, kNeighbours>;
  /// Sums of every part by the upper left pixel of the squares of its entries.
  using PartSums = std::vector<std::vector<Corners>>;

  [[nodiscard]] Stencil stencil(std::vector<float>& right_side) const;
  void multiply(const Stencil& stencil, const std::vector<float>& x, std::vector<float>& y,
                PartSums& sums) const;
  void multiply_unrolled(const Stencil& stencil, const std::vector<float>& x, std::vector<float>& y,
                         PartSums& sums) const;
  /// sum_r n_r m_r (m_r . x) of a part.
  void multiply_runs(const Part& part, const std::vector<float>& x,
                     std::vector<Corners>& sums) const;
  /// That of all parts and of the smoothness.
  [[nodiscard]] std::vector<Stiffness> stiffness() const;

  [[nodiscard]] bool wraps() const { return columns_ > width_; }
  /// Index of a pixel in the unrolled image.
  [[nodiscard]] int unrolled(int i) const { return wraps() ? i + i / width_ : i; }
  [[nodiscard]] std::vector<float> unrolled(const std::vector<float>& image) const;
  /// The transpose of it: adds the repeated column to the first one.
  [[nodiscard]] std::vector<float> folded(const std::vector<float>& sums) const;

  int width_, height_;
  int columns_;  ///< of the unrolled image; the members below are of it
  std::vector<std::array<float, kNeighbours>> rows_;
  CoarseGrid coarse_;
  std::vector<std::uint32_t> coarse_cell_;  ///< of every pixel of the unrolled image
  std::vector<Stiffness> smoothness_;       ///< of the coarse grid's cells
  std::vector<Part> parts_;
  float level_weight_ = 0;
};

}  // namespace saccade
