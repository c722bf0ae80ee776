#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/io/dataset/dataset.h"
#include "core/rigid3.h"

namespace saccade {

/// Which reference views the map is made from.
struct ReferenceOptions {
  std::optional<int> frame;
  std::optional<double> planar_depth_m;
  std::optional<std::array<double, 4>> region_px;  ///< on the undistorted sensor
  std::optional<double> new_view_deg;
  double time_offset_s = 0;
};

/// The view that the map is taken from, on the undistorted sensor.
struct ReferenceView {
  ImageF log_intensity;  ///< ln(eps + I); NaN where the lens shows nothing
  ImageF depth;          ///< z [m], 0 = unknown
  Rigid3 world_from_reference;
};

/// Loads the reference frame, as `camera` with its lens took it, with its depth and its true pose
/// (identity where the dataset has no ground truth: the reference view is the world then), and with
/// `new_view_deg` the later frames that the map needs. `start_s` chooses the first frame by
/// default, `end_s` is the end of what is tracked. Throws InputError naming the dataset when a
/// frame, a depth map at its time, or a pose is missing.
[[nodiscard]] std::vector<ReferenceView> load_references(const Dataset& dataset,
                                                         const PinholeCamera& camera,
                                                         const ReferenceOptions& options,
                                                         double start_s, double end_s);

/// The image that a camera without distortion would have taken; bilinear, `outside` beyond the
/// border.
[[nodiscard]] ImageF undistort_bilinear(const ImageF& image, const PinholeCamera& camera,
                                        float outside);
/// The same with the nearest pixel, for depths, which must not be mixed across an edge.
[[nodiscard]] ImageF undistort_nearest(const ImageF& image, const PinholeCamera& camera,
                                       float outside);

}  // namespace saccade
