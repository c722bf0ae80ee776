#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>

#include "core/stopwatch.h"
#include "core/trajectory.h"

namespace saccade {

/// What a run that goes on shows to whoever looks on: where its dataset is and the path that it has
/// found so far, in the hidden folder where the run grows (AtomicFolder). There is always a whole
/// one, and none any more when the folder gets its name.
class PathSoFar {
 public:
  /// Writes nothing yet. `run`: the folder that grows; `dataset`: that of the run.
  PathSoFar(const std::filesystem::path& run, const std::filesystem::path& dataset);

  /// Writes the path if it has not been written for kEvery_s, or never: at most kMostPoses of its
  /// poses, evenly spaced, the last one among them. No poses: nothing is done. What cannot be written
  /// is not shown, since a run must not fail for that.
  void show(std::span<const StampedPose> path);

  /// Rare and short enough that a run takes as long with it: a millisecond a second.
  static constexpr double kEvery_s = 0.5;
  static constexpr std::size_t kMostPoses = 500;

 private:
  std::filesystem::path folder_;
  std::filesystem::path dataset_;
  std::filesystem::path last_;  ///< file; empty before the first
  std::size_t written_ = 0;
  std::optional<Stopwatch> since_last_;
};

/// Removes what the run in `run` has shown.
void remove_path_so_far(const std::filesystem::path& run);

struct ShownPath {
  std::filesystem::path dataset;
  Trajectory path;  ///< world_from_camera
};

/// What the run that grows in `run` shows; nullopt where it shows nothing. InputError where the file
/// is malformed.
[[nodiscard]] std::optional<ShownPath> read_path_so_far(const std::filesystem::path& run);

}  // namespace saccade
