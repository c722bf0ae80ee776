#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "core/io/dataset/dataset.h"
#include "core/io/run/view_list.h"
#include "core/trajectory.h"
#include "estimator/reconstruction/place_finder.h"
#include "estimator/reconstruction/plane_labels.h"

namespace saccade {

struct DepthSourceOptions {
  enum class Propagation { kSurface, kSplat };

  /// How depth gets from the view where it is known to others: a surface between neighbouring
  /// pixels, or the thesis's Gaussians (6.3).
  Propagation propagation = Propagation::kSurface;
  int kernel_px = 3;         ///< of kSplat; odd
  PlaneLabelOptions planes;  ///< of a map through points
};

/// The scene as one depth map [m], 0 = unknown, of `camera` with its lens knows it.
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

  /// The scene as known around `reference_s`: by the dataset's map nearest in time, or by all
  /// points of the run's views, joined to a dense map of the view at `reference_s`.
  [[nodiscard]] DepthScene scene_at(double reference_s) const;

 private:
  [[nodiscard]] ImageF joined_points(const Rigid3& world_from_reference) const;

  const Dataset& dataset_;
  const Trajectory& trajectory_;
  DepthSourceOptions options_;
  std::vector<RunView> views_;  ///< of the depth run; empty: the dataset's maps
};

}  // namespace saccade
