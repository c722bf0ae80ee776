#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/config/fields.h"
#include "estimator/imu/orientation.h"
#include "estimator/mosaic/mosaic.h"

namespace saccade {

/// The configuration of `saccade run mosaic`; describe() names the keys, ranges and defaults.
struct MosaicConfig {
  enum class Extent {
    kSwept,  ///< the directions that the camera covered
    kSphere  ///< all directions
  };

  OrientationOptions orientation;
  bool estimate_rate_offset = false;
  MosaicOptions mosaic;
  std::optional<double> panorama_px_per_rad;  ///< nullopt: that of the sensor's middle
  Extent extent = Extent::kSwept;
  std::optional<double> contrast_on;  ///< nullopt: the dataset's
  std::optional<double> contrast_off;
  std::vector<std::int64_t> snapshot_events;
  std::uint64_t seed = 1;
};

void describe(config::Fields& fields, MosaicConfig& config);

}  // namespace saccade
