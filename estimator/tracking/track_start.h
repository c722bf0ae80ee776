#pragma once

#include <optional>
#include <vector>

#include "core/camera.h"
#include "core/io/dataset/dataset.h"
#include "core/rigid3.h"
#include "estimator/tracking/gyroscope.h"
#include "estimator/tracking/reference_view.h"
#include "estimator/tracking/track_config.h"

namespace saccade {

/// What a tracker starts from beside its measurements, read from a dataset.
struct TrackStart {
  PinholeCamera camera;  ///< with its lens
  std::vector<ReferenceView> references;
  Rigid3 world_from_camera;               ///< at the start
  std::optional<EventContrast> contrast;  ///< nullopt: nobody states it
  Gyroscope gyroscope;                    ///< empty unless it is needed
};

/// For tracking from `start_s` to `end_s`. Throws InputError for what the dataset lacks, with the key
/// that could state it instead.
[[nodiscard]] TrackStart load_track_start(const TrackConfig& config, const Dataset& dataset,
                                          double start_s, double end_s);

/// The map that `start` shows.
[[nodiscard]] TrackWorld world_of(const TrackConfig& config, const TrackStart& start);

}  // namespace saccade
