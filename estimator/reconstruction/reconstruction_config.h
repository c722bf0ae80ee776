#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "core/camera.h"
#include "core/config/fields.h"
#include "estimator/reconstruction/image_methods.h"
#include "estimator/reconstruction/image_solver.h"
#include "estimator/reconstruction/surface/depth_source.h"
#include "estimator/run/view_windows.h"

namespace saccade {

/// The configuration of `saccade run reconstruct`; describe() names the keys, ranges and defaults.
struct ReconstructionConfig : ImageMethodOptions {
  /// The whole as one view, at a grey frame that it can be compared with.
  ViewWindowOptions window{.duration_s = 3600,
                           .events = std::nullopt,
                           .reference = ViewWindowOptions::Reference::kFrame};
  DepthSourceOptions depth;
  std::optional<std::filesystem::path> sensor;  ///< sensor.yaml, default of the thresholds
  std::optional<double> contrast_on;            ///< nullopt: the dataset's
  std::optional<double> contrast_off;
  std::vector<std::int64_t> snapshot_events;
  bool figures = false;
  std::uint64_t seed = 1;
};

void describe(config::Fields& fields, ReconstructionConfig& config);

/// The method that the configuration names. `camera` with its lens.
[[nodiscard]] std::unique_ptr<ImageEstimator> make_image_estimator(
    const ReconstructionConfig& config, const PinholeCamera& camera);

}  // namespace saccade
