#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/image.h"
#include "estimator/reconstruction/place_finder.h"
#include "estimator/run/view_windows.h"

namespace saccade {

/// What one view is reconstructed from.
struct ReconstructionWindow : ViewWindow {
  DepthScene scene;           ///< the surfaces that are known
  double contrast_on = 0.2;   ///< C+ > 0 [log units]
  double contrast_off = 0.2;  ///< C- > 0
};

/// A reconstructed view; all images have the size of the camera, undistorted.
struct Reconstruction {
  ImageF log_image;                                    ///< log intensity, of mean 0
  ImageF gradient_x, gradient_y;                       ///< at the pixels' centres [log units/px]
  ImageF covariance_xx, covariance_xy, covariance_yy;  ///< of the gradient [(log units/px)^2]
  ImageU8 observed;        ///< 1 where events or their absence say something
  std::size_t levels = 0;  ///< measurements that were used
  std::vector<std::pair<std::string, double>> stages_s;  ///< the same in all windows
};

/// Told, now and then, the share of the work that is done; it rises to 1.
using ShareDone = std::function<void(double share)>;

/// A method that turns events, poses and depth into an image. Few events give a poor image, never
/// an error.
class ImageEstimator {
 public:
  virtual ~ImageEstimator() = default;
  /// Thread-safe; the result depends on the window alone.
  [[nodiscard]] virtual Reconstruction reconstruct(const ReconstructionWindow& window) const = 0;
};

}  // namespace saccade
