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

/// What is known of the image at a place.
struct GridLevel {
  GridPoint place;
  float level, weight;
};

struct GridSolution {
  ImageF image;         ///< up to a constant
  int iterations = 0;   ///< of conjugate gradients
  double residual = 0;  ///< |r| / |b| in the preconditioner's norm
};

/// Weighted linear least squares over the pixels of an image and one offset c per track:
///   min over I, c of  sum_k w_k (I(place_k) - c_track(k) - level_k)^2
/// which leaves a constant of the image open: it stays that of the first guess.
/// The offsets are eliminated: with m_t the mean of a track's rows, n_t the sum of its weights, the
/// normal matrix is the pixels' own (a stencil) minus sum_t n_t m_t m_t^T. Solved by conjugate
/// gradients, preconditioned in the cosine domain: a wave shorter than the tracks is seen by every
/// level, of a longer one only its slope. An image that wraps is unrolled by one column, the first
/// one once more, behind which it ends like any other.
class LevelSystem {
 public:
  /// `wraps`: the last column is the first one's neighbour.
  LevelSystem(int width, int height, bool wraps = false);

  /// Forgets what was added, but keeps the memory.
  void clear();

  /// Room for so many levels.
  void reserve(std::size_t levels) { entries_.reserve(levels); }

  /// The levels of one track. A place's four pixels are a square, the first its upper left; it may
  /// lie across the seam of an image that wraps.
  void add_track(std::span<const GridLevel> levels);

  /// w (I(j) - I(i))^2 for two neighbours.
  void add_smooth(int i, int j, float weight);

  /// Until the residual has fallen to `tolerance`. `start`: first guess, empty: 0.
  [[nodiscard]] GridSolution solve(int iterations, double tolerance,
                                   const ImageF& start = {}) const;

 private:
  static constexpr int kNeighbours = 5;  ///< itself, right, left below, below, right below

  /// A level's share of its track's mean.
  struct Entry {
    int index;  ///< of the upper left pixel
    std::array<float, 4> factor;
  };
  struct Track {
    std::size_t begin, end;  ///< of its entries
    float weight;
  };

  /// rows_ with what the levels add, one neighbour after the other.
  using Stencil = std::array<std::vector<float>, kNeighbours>;

  [[nodiscard]] Stencil stencil(std::vector<float>& right_side) const;
  void multiply(const Stencil& stencil, const std::vector<float>& x, std::vector<float>& y) const;
  void multiply_unrolled(const Stencil& stencil, const std::vector<float>& x,
                         std::vector<float>& y) const;
  [[nodiscard]] double track_variance() const;

  [[nodiscard]] bool wraps() const { return columns_ > width_; }
  /// The pixel in the unrolled image.
  [[nodiscard]] int unrolled(int i) const { return wraps() ? i + i / width_ : i; }
  [[nodiscard]] std::vector<float> unrolled(const std::vector<float>& image) const;
  /// The transpose of it: what is found for the last column is the first one's, too.
  [[nodiscard]] std::vector<float> rolled_up(const std::vector<float>& sums) const;

  int width_, height_;
  int columns_;  ///< of the unrolled image, which what follows is of
  std::vector<std::array<float, kNeighbours>> rows_;
  std::vector<Lanes> cells_;  ///< what levels add, by the upper left pixel of their square
  std::vector<Entry> entries_;
  std::vector<Track> tracks_;
};

}  // namespace saccade
