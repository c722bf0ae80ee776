#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "estimator/reconstruction/observations/intensity_observations.h"

namespace saccade::testing {

/// The observations of a window, one band after the other.
inline std::vector<IntensityObservation> observations_of(ObservationSource& source,
                                                         std::span<const Event> events,
                                                         const Trajectory& world_from_camera,
                                                         std::size_t bands) {
  std::vector<std::vector<IntensityObservation>> of_bands(bands);
  source.observe(
      events, world_from_camera, bands,
      [&](std::size_t band, std::span<const IntensityObservation> part) {
        of_bands[band].insert(of_bands[band].end(), part.begin(), part.end());
      },
      [](double) {});
  std::vector<IntensityObservation> all;
  for (const auto& band : of_bands) all.insert(all.end(), band.begin(), band.end());
  return all;
}

}  // namespace saccade::testing
