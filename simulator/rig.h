#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "core/io/calibration_file.h"
#include "simulator/simulation_config.h"

namespace saccade {

/// One camera of what is simulated: the first one of the configuration, or one fixed to it.
struct RigCamera {
  PinholeCamera camera;
  EventOptions events;
  Rigid3 camera0_from_camera;
  std::uint64_t seed;  ///< of its random numbers; the first camera's is the configuration's
  std::filesystem::path folder;  ///< within the dataset: none for the first, then cam1, cam2 ...
};

/// All cameras, the first one first. Throws InputError naming a camera that is none.
[[nodiscard]] std::vector<RigCamera> rig_cameras(const SimulationConfig& config);

/// What camera.yaml states about `cameras`, each with the transformation from the one before it,
/// and from the IMU where there is one.
[[nodiscard]] std::vector<ChainCamera> camera_chain(std::span<const RigCamera> cameras,
                                                    const ImuOptions& imu);

}  // namespace saccade
