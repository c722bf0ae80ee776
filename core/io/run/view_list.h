#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "core/rigid3.h"

namespace saccade {

/// A view that an estimator wrote pictures of: one entry of views.yaml. Files are absolute or
/// relative to the working folder, in the file relative to it; empty where nothing was written.
struct RunView {
  double t_s = 0;
  Rigid3 world_from_camera;
  double start_s = 0;  ///< of the events that it was made from
  double end_s = 0;
  std::filesystem::path depth;      ///< EXR: Z [m], variance of Z [m^2]; 0 = unknown; undistorted
  std::filesystem::path keypoints;  ///< PNG: where depth was looked for and found
  std::filesystem::path gradient;   ///< EXR
  std::filesystem::path image;      ///< EXR
};

/// InputError with file:line; times must increase.
[[nodiscard]] std::vector<RunView> read_view_list(const std::filesystem::path& file);
void write_view_list(const std::filesystem::path& file, std::span<const RunView> views);

}  // namespace saccade
