#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "core/config/fields.h"
#include "core/io/dataset/dataset.h"
#include "core/io/run/view_list.h"
#include "core/trajectory.h"
#include "estimator/reconstruction/observations/reprojector.h"

namespace saccade {

struct DepthSourceOptions {
  enum class Propagation { kSurface, kSplat };

  Propagation propagation = Propagation::kSurface;
  int kernel_px = 3;  ///< of kSplat: side of the Gaussian of a point; odd (thesis fig. 6.2)
};

void describe(config::Fields& fields, DepthSourceOptions& options);

/// The scene of one depth map [m], 0 = unknown, of `camera` with its lens.
[[nodiscard]] DepthScene scene_of(const ImageF& depth, const PinholeCamera& camera,
                                  const Rigid3& world_from_depth,
                                  const DepthSourceOptions& options);

/// Where the depth of the scene comes from: the depth maps of a dataset or the views of a depth
/// run.
class DepthSource {
 public:
  /// The dataset's maps or, where it is given, the run folder's. `trajectory`: world_from_camera.
  /// Throws InputError where there is no depth.
  DepthSource(const Dataset& dataset, const std::optional<std::filesystem::path>& depth_from,
              const Trajectory& trajectory, const DepthSourceOptions& options);

  /// The scene around `reference_s`: from the dataset's map nearest in time, or from the points of all
  /// views of the run, as a dense map of the view at `reference_s`.
  [[nodiscard]] DepthScene scene_at(double reference_s) const;

 private:
  [[nodiscard]] ImageF dense_depth(const Rigid3& world_from_reference) const;

  const Dataset& dataset_;
  const Trajectory& trajectory_;
  DepthSourceOptions options_;
  std::vector<RunView> views_;  ///< of the depth run; empty: the dataset's maps
};

}  // namespace saccade
