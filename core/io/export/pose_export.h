#pragma once

#include <filesystem>

#include "core/io/dataset/dataset.h"
#include "core/trajectory.h"

namespace saccade {

/// transforms.json of nerfstudio: the camera and, for every frame of `dataset` within the
/// trajectory's time, its picture (relative to `file`, where the folder is the same) and its pose.
/// Cameras of nerfstudio look along -z with y upwards, and count pixels from the corner of the
/// picture, so that cx and cy are greater by 0.5. How many frames there are; InputError where there
/// are none.
std::size_t write_nerfstudio(const Dataset& dataset, const Trajectory& trajectory,
                             const std::filesystem::path& file);

/// The folder that rpg_trajectory_evaluation expects, and evo reads as TUM: stamped_groundtruth.txt
/// and stamped_traj_estimate.txt. InputError where one of them is empty.
void write_trajectory_evaluation(const Trajectory& truth, const Trajectory& estimate,
                                 const std::filesystem::path& folder);

}  // namespace saccade
