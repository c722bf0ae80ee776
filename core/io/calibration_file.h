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

/// The first camera of a camchain file in Kalibr's layout (cam0: pinhole; radtan, equidistant or
/// none). A fifth distortion coefficient is k3, which Kalibr itself does not have; it is written
/// only when not 0. An equidistant lens becomes the nearest radial-tangential one (fit_pinhole());
/// InputError where that is off by more than kMostFitResidual_px.
[[nodiscard]] PinholeCamera read_camera_yaml(const std::filesystem::path& file);
void write_camera_yaml(const std::filesystem::path& file, const PinholeCamera& camera);

/// More than that, another lens model does not stand for a lens [px].
constexpr double kMostFitResidual_px = 0.1;

/// One camera of a rig.
struct ChainCamera {
  PinholeCamera camera;
  std::optional<Rigid3> camera_from_imu{};       ///< key T_cam_imu
  std::optional<Rigid3> camera_from_previous{};  ///< key T_cn_cnm1: from the camera before it
  double timeshift_s = 0;  ///< key timeshift_cam_imu: time of the inertial sensor - of the camera
  double residual_px = 0;  ///< what the lens model was changed by at most
};

/// All cameras of a camchain file, cam0, cam1 ... in order. InputError with `file:line`.
[[nodiscard]] std::vector<ChainCamera> read_camera_chain(const std::filesystem::path& file);
void write_camera_chain(const std::filesystem::path& file, std::span<const ChainCamera> cameras);

}  // namespace saccade
