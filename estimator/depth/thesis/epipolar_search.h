#pragma once

#include <Eigen/Core>

#include "core/image.h"

namespace saccade {

/// The thresholds beside the patch decide which matches are refused; what the thesis leaves open.
struct SearchOptions {
  int patch_radius_px = 5;       ///< r: a patch has 2 r + 1 pixels on each side
  int iterations = 10;           ///< most Gauss-Newton iterations; matches need 3 to 5
  double max_shift_px = 5;       ///< a patch's radius: beyond it the patches have nothing in common
  double min_alignment = 0.25;   ///< of the mean cos^2 between gradient and line: 60 degrees
  double min_correlation = 0.5;  ///< of the two patches where the search ends
};

/// A square of an event frame around a sub-pixel position, with zero mean and unit norm, row by
/// row, and its derivatives.
class FramePatch {
 public:
  /// True where the patch and one pixel around it lie within the frame.
  [[nodiscard]] static bool fits(const ImageF& frame, const Eigen::Vector2d& centre, int radius);

  /// `centre` fits. A flat patch is all zero.
  FramePatch(const ImageF& frame, const Eigen::Vector2d& centre, int radius);

  [[nodiscard]] const Eigen::VectorXf& values() const { return values_; }
  [[nodiscard]] const Eigen::VectorXf& dx() const { return dx_; }  ///< [1/px], zero mean
  [[nodiscard]] const Eigen::VectorXf& dy() const { return dy_; }

 private:
  Eigen::VectorXf values_, dx_, dy_;
};

enum class SearchStatus { kFound, kOutside, kNoGradient, kDiverged, kDifferent };

struct SearchResult {
  SearchStatus status = SearchStatus::kDiverged;
  double shift_px = 0;     ///< along the line from the start; of kFound and kDifferent
  double correlation = 0;  ///< of the patches there, -1..1
};

/// Lucas-Kanade with the position on the epipolar line as the only parameter (thesis 5.1-5.4):
///   minimise sum (I(W(u; p)) - T(u))^2,  W(u; p) = u_init + p (cos th, sin th),
///   J = grad T . (cos th, sin th),  p <- p - (sum J (I - T)) / sum J^2   (inverse compositional).
/// Both patches have zero mean and unit norm, so that only their shapes count. `start` = u_init
/// [px], `direction` of unit length.
[[nodiscard]] SearchResult search_along(const FramePatch& reference, const ImageF& frame,
                                        const Eigen::Vector2d& start,
                                        const Eigen::Vector2d& direction,
                                        const SearchOptions& options);

}  // namespace saccade
