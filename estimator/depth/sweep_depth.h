#pragma once

#include "core/camera.h"
#include "core/image.h"
#include "estimator/depth/depth_estimator.h"
#include "estimator/depth/event_rays.h"
#include "estimator/depth/outlier_removal.h"

namespace saccade {

struct SweepDepthOptions {
  int planes = 100;        ///< of equal steps in inverse depth
  int threshold_side = 5;  ///< odd; of the Gaussian neighbourhood of the adaptive threshold [px]
  double threshold = 6;    ///< above the neighbourhood's mean; the most votes are 255
  int median_side = 5;     ///< odd; of the median over a point's neighbourhood, 1: none
  OutlierOptions outliers;
};

/// The space sweep that stands alone, as public mappers do it and as a baseline for other methods:
/// every event's ray votes bilinearly on planes of equal steps in inverse depth; a pixel takes the
/// plane with the most votes, where they exceed a Gaussian mean of their neighbourhood; then a
/// median and radius outlier removal. (H. Rebecq et al., EMVS, IJCV 2018; covered by patent
/// WO2018/037079.) The deviation is that of a value anywhere between two planes.
class SweepDepth : public DepthEstimator {
 public:
  SweepDepth(const SweepDepthOptions& options, const DepthLimits& limits,
             const PinholeCamera& camera);

  [[nodiscard]] DepthResult estimate(const ViewWindow& window) const override;

 private:
  /// The most votes of each pixel, and the inverse depth where.
  struct Peaks {
    ImageF votes;
    ImageF inverse_depth;
  };
  [[nodiscard]] bool has_parallax(const EventRays& rays) const;
  [[nodiscard]] Peaks sweep(const EventRays& rays) const;
  [[nodiscard]] std::vector<EdgeDepth> select(const Peaks& peaks) const;
  [[nodiscard]] double step() const;

  SweepDepthOptions options_;
  DepthLimits limits_;
  PinholeCamera camera_;  ///< undistorted
  UndistortionTable undistortion_;
};

}  // namespace saccade
