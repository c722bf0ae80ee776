#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "core/rigid3.h"

namespace saccade {

/// One entry of keyframes.yaml, beside the view of the same index in views.yaml: when a keyframe of
/// an odometry run was made and used.
struct KeyframeEntry {
  double t_s = 0;  ///< of its view
  Rigid3 world_from_camera;
  double made_s = 0;                 ///< last event that it was made of
  double taken_s = 0;                ///< last event before it came into force; the first: made_s
  std::int64_t events = 0;           ///< that it was made of
  std::int64_t points = 0;           ///< with depth
  std::int64_t edges = 0;            ///< that became the map: so many points of map.ply, in order
  double typical_depth_m = 0;        ///< median of its depths
  std::vector<std::int64_t> active;  ///< keyframes that made up the map from then on, by index
};

/// InputError with file:line; times must increase, active keyframes be in the list.
[[nodiscard]] std::vector<KeyframeEntry> read_keyframe_list(const std::filesystem::path& file);
void write_keyframe_list(const std::filesystem::path& file,
                         std::span<const KeyframeEntry> keyframes);

}  // namespace saccade
