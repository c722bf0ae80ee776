#pragma once

#include <filesystem>
#include <optional>

#include "core/io/calibration_file.h"
#include "core/io/events/event_file.h"

namespace saccade {

/// The calibration of a camera from any file that states one: calib.txt (calibration_file.h), a
/// camchain of Kalibr or a camera.yaml of a dataset (its first camera, or that of "FILE!/cam1"), or
/// a camera_info of ROS (keys image_width, camera_matrix, distortion_coefficients). `sensor` is the
/// size where the file states none, and must agree where it does; 0: unknown. InputError with
/// `file:line`.
[[nodiscard]] ChainCamera read_any_calibration(const std::filesystem::path& file,
                                               SensorSize sensor);

/// That of `chosen` or, where it is empty, of calib.txt or camera.yaml in `folder`; nullopt where
/// there is none.
[[nodiscard]] std::optional<ChainCamera> find_calibration(const std::filesystem::path& chosen,
                                                          const std::filesystem::path& folder,
                                                          SensorSize sensor);

}  // namespace saccade
