#pragma once

#include "core/camera.h"
#include "core/image.h"
#include "estimator/depth/depth_estimator.h"
#include "estimator/depth/rays/event_rays.h"

namespace saccade {

/// The space sweep by itself, as EMVS and its successors do it: the baseline for other methods.
/// Every event's ray votes bilinearly on planes equally spaced in inverse depth; a pixel takes the
/// plane with the most votes, where they exceed a Gaussian mean of their neighbourhood; a median
/// and radius outlier removal follow. (H. Rebecq et al., EMVS, IJCV 2018; covered by patent
/// WO2018/037079.) Sigma is that of a value uniformly distributed between two planes.
class SweepDepth : public DepthEstimator {
 public:
  SweepDepth(const DepthLimits& limits, const PinholeCamera& camera);

  [[nodiscard]] DepthResult estimate(const ViewWindow& window) const override;

 private:
  /// Maximum of the votes over the planes at each pixel, and its inverse depth.
  struct Peaks {
    ImageF votes;
    ImageF inverse_depth;
  };
  [[nodiscard]] bool has_parallax(const EventRays& rays) const;
  [[nodiscard]] Peaks sweep(const EventRays& rays) const;
  [[nodiscard]] std::vector<EdgePoint> select(const Peaks& peaks) const;
  /// Between neighbouring planes [1/m].
  [[nodiscard]] double spacing() const;

  DepthLimits limits_;
  PinholeCamera camera_;  ///< undistorted
  UndistortionTable undistortion_;
};

}  // namespace saccade
