#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/image.h"
#include "core/rigid3.h"
#include "estimator/tracking/reference_view.h"

namespace saccade {

/// The known world of the intensity tracker: what one or more views show, as points with a log
/// intensity. The pictures lie one below the other in an atlas, so that a pixel of any of them is
/// one pair of coordinates.
class IntensityMap {
 public:
  /// Point samples do not determine the sub-pixel position of an edge: of tracking and refinement.
  static constexpr double kEdgeBlur_px = 0.8;

  /// `camera` is undistorted and that of all views; the map's frame is that of the first of them.
  /// At least one view.
  /// `edge_blur_px`: sigma of the Gaussian that smooths the pictures at their edges; 0: none.
  IntensityMap(const PinholeCamera& camera, std::span<const ReferenceView> views,
               double edge_blur_px);

  /// A view's picture in the atlas, its pose, and its points [m].
  struct View {
    Rigid3 view_from_map;
    int first_row = 0;                    ///< in the atlas
    std::vector<Eigen::Vector3f> points;  ///< in the map's frame, row by row
    std::vector<float> inverse_depth;     ///< [1/m]; 0 where there is none
    /// 1 where a pixel and its neighbours to the right, below, and both show one surface. Very
    /// different depths belong to different surfaces.
    std::vector<std::uint8_t> is_joined;
  };
  [[nodiscard]] const std::vector<View>& views() const { return views_; }
  [[nodiscard]] const PinholeCamera& camera() const { return camera_; }
  [[nodiscard]] const Rigid3& world_from_map() const { return world_from_map_; }

  /// Log intensities, NaN where the lens shows nothing and in a row between two pictures, so that
  /// none goes on into the next.
  [[nodiscard]] const ImageF& atlas() const { return atlas_; }
  /// By how much the log intensity may be off, per px^2 of the variance of a position: what the
  /// pictures' pixels differ by around each of them, squared [1/px^2]. Of the same size.
  [[nodiscard]] const ImageF& variance() const { return variance_; }
  /// The least and the greatest value of each pixel and its neighbours. Of the same size.
  [[nodiscard]] const ImageF& least() const { return least_; }
  [[nodiscard]] const ImageF& greatest() const { return greatest_; }
  /// The mean fraction of an edge's contrast that lies between two neighbouring pixels: 0.64
  /// measured where pixels average over their area, 0.84 to 0.95 where they are point samples; 0
  /// without edges.
  [[nodiscard]] double edge_sharpness() const { return edge_sharpness_; }

 private:
  PinholeCamera camera_;
  Rigid3 world_from_map_;
  ImageF atlas_, variance_, least_, greatest_;
  double edge_sharpness_ = 0;
  std::vector<View> views_;
};

}  // namespace saccade
