#pragma once

#include <filesystem>
#include <string>

namespace saccade {

/// What `saccade convert` makes of poses.
struct PoseConversion {
  std::filesystem::path input;
  std::filesystem::path output;
  std::filesystem::path dataset;  ///< --data: whose frames COLMAP's pictures are; empty: none
};

/// Writes poses of COLMAP or of a CSV as TUM's text, the frames and poses of a dataset or a run as
/// nerfstudio's transforms.json, or a run as the folder of rpg_trajectory_evaluation. What was written,
/// for a person; "" where input and output are none of these.
[[nodiscard]] std::string convert_poses(const PoseConversion& conversion);

}  // namespace saccade
