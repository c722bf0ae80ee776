#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "eval/view/view_content.h"

namespace saccade {

/// A grey frame of a recording: the PNG as it lies there, or one of its radiance.
struct ViewPicture {
  std::string type;  ///< MIME
  std::string bytes;
};

/// A PNG file as it is.
[[nodiscard]] ViewPicture stored_picture(const std::filesystem::path& file);
[[nodiscard]] ViewPicture frame_picture(const ViewRecording& recording, std::size_t index);
[[nodiscard]] ViewPicture depth_picture(const ViewRecording& recording, std::size_t index);
/// What a run found of its view `index`, whose file must be stated (contract).
[[nodiscard]] ViewPicture run_depth_picture(const ViewRun& run, const ViewRecording& recording,
                                            std::size_t index);
[[nodiscard]] ViewPicture run_image_picture(const ViewRun& run, std::size_t index);

/// Points in the world, 3 x f32 each, little-endian [m], at most kMostCloudPoints: the run's
/// cloud.ply or map.ply.
[[nodiscard]] std::string run_cloud(const ViewRun& run);
/// The same of a recording: its depth maps seen from the true poses; empty where it lacks one.
[[nodiscard]] std::string recording_cloud(const ViewRecording& recording);

constexpr std::size_t kMostCloudPoints = 40'000;

}  // namespace saccade
