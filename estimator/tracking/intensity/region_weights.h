#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace saccade {

/// How much the residuals of each part of the image count: where they have been larger than elsewhere
/// for a while, something is there that the map does not hold, as an object that moves. A robust loss
/// judges one residual at a time and accepts the small ones of such an object as inliers.
class RegionWeights {
 public:
  /// Of the image [px], both > 0.
  RegionWeights(int width, int height);

  /// The region of a pixel, finite; of the nearest pixel inside where it lies outside the image.
  [[nodiscard]] std::size_t region_of(const Eigen::Vector2f& pixel) const;
  /// min(1, 2 q_usual / q) with q the mean of relative residuals in the region: > 0.
  [[nodiscard]] float weight(std::size_t region) const { return weights_[region]; }

  /// A residual of the pose at work: `relative` = r^2 in units of the square at which Cauchy's weight
  /// is a half, >= 0; `certainty` of the observation, 0..1: how much the residual says of the map.
  void add(std::size_t region, float relative, float certainty);
  /// Takes in what was added since the last call.
  void learn();
  /// All regions weigh 1.
  void reset();

 private:
  struct Region {
    float count = 0, sum = 0;          ///< of the past, fading; residuals by their certainty
    float new_count = 0, new_sum = 0;  ///< since the last learn()

    [[nodiscard]] float mean() const { return sum / count; }
  };

  int side_px_;
  int columns_, rows_;
  float memory_;
  std::vector<Region> regions_;
  std::vector<float> weights_;
  std::vector<float> means_;  ///< scratch
};

}  // namespace saccade
