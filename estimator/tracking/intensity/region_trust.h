#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace saccade {

/// How much the residuals of each part of the image count: where they have been larger than elsewhere
/// for a while, something is there that the map does not hold, as an object that moves. A robust loss
/// judges one residual at a time and takes those of such an object for a fair share of small ones.
class RegionTrust {
 public:
  RegionTrust(int width, int height);

  /// The region of a pixel; of the nearest one inside where it lies outside the image.
  [[nodiscard]] std::size_t region_of(const Eigen::Vector2f& pixel) const;
  /// 1 where residuals are as usual, less where they are larger; > 0.
  [[nodiscard]] float trust(std::size_t region) const { return trust_[region]; }

  /// A residual of the pose at work: `relative` = r^2 by its expectation, any unit; `weight` of the
  /// observation, 0..1.
  void add(std::size_t region, float relative, float weight);
  /// Takes in what was added since the last call.
  void learn();
  /// Trusts all regions alike.
  void reset();

 private:
  struct Region {
    float weight = 0, sum = 0;          ///< of the past, fading
    float new_weight = 0, new_sum = 0;  ///< since the last learn()

    [[nodiscard]] float mean() const { return sum / weight; }
  };

  int side_px_;
  int columns_, rows_;
  std::vector<Region> regions_;
  std::vector<float> trust_;
  std::vector<float> means_;  ///< scratch
};

}  // namespace saccade
