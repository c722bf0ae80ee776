#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/image.h"

namespace saccade {

/// A sub-pixel position on a grid of unknowns: the value there is the weighted mean of four of them
/// (thesis A.2). Weights sum to one.
struct GridPoint {
  std::array<int, 4> index;
  std::array<float, 4> weight;
};

struct GridSolution {
  ImageF image;         ///< up to a constant where only differences are known
  int iterations = 0;   ///< of conjugate gradients
  double residual = 0;  ///< |r| / |b| in the preconditioner's norm
};

/// Weighted linear least squares over the pixels of an image and one offset c per track:
///   min over I, c of  sum_k w_k (I(place_k) - c_track(k) - level_k)^2
/// The offsets are eliminated: with m_t the mean of a track's rows, n_t the sum of its weights, the
/// normal matrix is the pixels' own (a stencil) minus sum_t n_t m_t m_t^T. Solved by conjugate
/// gradients, preconditioned in the cosine domain: a wave shorter than the tracks is seen by every
/// level, of a longer one only its slope.
class LevelSystem {
 public:
  LevelSystem(int width, int height);

  /// Forgets what was added, but keeps the memory.
  void clear();

  /// Tracks come one after the other: begin_track(), then add() for its levels, end_track().
  void begin_track();
  void add(const GridPoint& place, float level, float weight);
  void end_track();

  /// w (I(j) - I(i))^2 for two neighbours.
  void add_smooth(int i, int j, float weight);
  /// w (I(i) - value)^2.
  void add_value(int i, float value, float weight);

  /// Until the residual has fallen to `tolerance`. `start`: first guess, empty: 0.
  [[nodiscard]] GridSolution solve(int iterations, double tolerance,
                                   const ImageF& start = {}) const;

 private:
  static constexpr int kNeighbours = 5;  ///< itself, right, left below, below, right below

  struct Entry {
    int index;
    float factor;
  };
  struct Track {
    std::size_t begin, end;  ///< of its entries
    float weight;
  };

  /// rows_, one neighbour after the other.
  using Stencil = std::array<std::vector<float>, kNeighbours>;

  [[nodiscard]] Stencil stencil() const;
  void multiply(const Stencil& stencil, const std::vector<float>& x, std::vector<float>& y) const;
  [[nodiscard]] double track_variance() const;

  int width_, height_;
  std::vector<std::array<float, kNeighbours>> rows_;
  std::vector<Entry> entries_;
  std::vector<Track> tracks_;
  std::vector<float> diagonal_;  ///< of the tracks' part
  std::vector<double> right_side_;
  // The track that is being added: the sum of its rows by pixel.
  std::vector<float> sum_;
  std::vector<int> touched_;
  double track_weight_ = 0, track_level_ = 0;
};

}  // namespace saccade
