#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/rigid3.h"

namespace saccade {

/// One line `fx fy cx cy k1 k2 p1 p2 k3` (Event Camera Dataset); `fx fy cx cy` alone is a camera
/// without distortion. The sensor size is not in the file and stays 0.
[[nodiscard]] PinholeCamera read_calib_txt(const std::filesystem::path& file);
void write_calib_txt(const std::filesystem::path& file, const PinholeCamera& camera);

/// The first camera of a camchain file in Kalibr's layout (cam0: pinhole, radtan or none). A fifth
/// distortion coefficient is k3, which Kalibr itself does not have; it is written only when not 0.
[[nodiscard]] PinholeCamera read_camera_yaml(const std::filesystem::path& file);
void write_camera_yaml(const std::filesystem::path& file, const PinholeCamera& camera);

/// One camera of a rig.
struct ChainCamera {
  PinholeCamera camera;
  std::optional<Rigid3> camera_from_imu;       ///< key T_cam_imu
  std::optional<Rigid3> camera_from_previous;  ///< key T_cn_cnm1: from the camera before it
};

/// All cameras of a camchain file, cam0, cam1 ... in order. InputError with `file:line`.
[[nodiscard]] std::vector<ChainCamera> read_camera_chain(const std::filesystem::path& file);
void write_camera_chain(const std::filesystem::path& file, std::span<const ChainCamera> cameras);

}  // namespace saccade
