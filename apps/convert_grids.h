#pragma once

#include <filesystem>
#include <string>

namespace saccade {

/// What `saccade convert` makes of events besides events: at most one of both is stated.
struct GridRequest {
  std::string voxel_grid;   ///< "bins=5,polarity=signed"; "default": all defaults
  std::string event_frame;  ///< "kind=count"

  [[nodiscard]] bool is_stated() const { return !voxel_grid.empty() || !event_frame.empty(); }
};

/// Writes the grids of the events of a file or a dataset; returns what was written, for a person.
[[nodiscard]] std::string convert_to_grids(const std::filesystem::path& input,
                                           const std::filesystem::path& output,
                                           const GridRequest& request);

}  // namespace saccade
