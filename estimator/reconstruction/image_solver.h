#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "estimator/reconstruction/contrast_thresholds.h"
#include "estimator/reconstruction/observations/intensity_observations.h"
#include "estimator/reconstruction/observations/reference_grid.h"
#include "estimator/run/view_windows.h"

namespace saccade {

/// The input of one view.
struct ReconstructionWindow : ViewWindow {
  DepthScene scene;  ///< the known surfaces
  ContrastThresholds thresholds{0.2, 0.2};
};

/// A reconstructed view; all images have the size of the camera, undistorted.
struct Reconstruction {
  ImageF log_image;                                    ///< log intensity, of mean 0
  ImageF gradient_x, gradient_y;                       ///< at the pixels' centres [log units/px]
  ImageF covariance_xx, covariance_xy, covariance_yy;  ///< of the gradient [(log units/px)^2]
  ImageU8 observed;              ///< 1 where events or no-event constraints determine the image
  std::size_t observations = 0;  ///< number of observations
  std::vector<std::pair<std::string, double>> stages_s;  ///< the same names in all windows
};

/// Called now and then with the completed fraction of the work, which rises to 1.
using ProgressCallback = std::function<void(double fraction)>;

/// A method that turns observations of log intensity into an image, of a view as of a panorama. Few
/// events give a poor image, never an error.
class ImageSolver {
 public:
  virtual ~ImageSolver() = default;
  /// Thread-safe. `grid`: the pixels of the view or panorama that `source` observes.
  [[nodiscard]] virtual Reconstruction solve(ObservationSource& source,
                                             std::span<const Event> events,
                                             const Trajectory& world_from_camera,
                                             const ReferenceGrid& grid,
                                             const ProgressCallback& progress = {}) const = 0;
};

/// Reconstructs views of known depth with one of the methods.
class ImageEstimator {
 public:
  /// `camera` with its lens.
  ImageEstimator(const PinholeCamera& camera, const ObservationOptions& options,
                 std::unique_ptr<ImageSolver> solver)
      : camera_(camera), options_(options), solver_(std::move(solver)) {}
  /// Thread-safe; the result depends on the window alone.
  [[nodiscard]] Reconstruction reconstruct(const ReconstructionWindow& window) const {
    const Rigid3 world_from_reference = window.world_from_reference();
    ImageF inverse_depth(camera_.width, camera_.height);
    window.scene.draw(world_from_reference.inverse(), camera_.undistorted(), inverse_depth);
    const ReferenceGrid grid(std::move(inverse_depth));
    SurfaceObservations source(camera_, window.scene, world_from_reference, grid.inverse_depth(),
                               window.thresholds, options_);
    return solver_->solve(source, window.events, *window.trajectory, grid);
  }

 private:
  PinholeCamera camera_;
  ObservationOptions options_;
  std::unique_ptr<ImageSolver> solver_;
};

}  // namespace saccade
