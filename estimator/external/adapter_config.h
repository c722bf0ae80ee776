#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "core/config/fields.h"

namespace saccade {

enum class HandoverEvents { kText, kH5, kCsv };
enum class StampUnit { kSeconds, kMilliseconds, kMicroseconds, kNanoseconds };

/// The trajectory that an external program writes: a line for each pose, numbers separated by
/// blanks or commas; lines that begin with '#' and a first line of column names are skipped.
struct TrajectoryFormat {
  /// `t x y z qx qy qz qw`, or with the quaternion's w first (EuRoC).
  enum class Columns { kTum, kEuroc };
  enum class Convention { kWorldFromCamera, kCameraFromWorld };

  std::string file = "trajectory.txt";  ///< in {out}
  Columns columns = Columns::kTum;
  StampUnit time_unit = StampUnit::kSeconds;
  Convention poses = Convention::kWorldFromCamera;
  double time_offset_s = 0;  ///< added to every stamp
};

/// What an external program leaves in {out}. Paths are relative to it.
struct AdapterOutput {
  TrajectoryFormat trajectory;
  /// As the files of the same name in a run folder; empty: none.
  std::string covariance;  ///< covariance.txt
  std::string map;         ///< map.ply, the points that were tracked
  std::string views;       ///< folder with views.yaml and depth maps
};

/// How to run somebody else's estimator (docs/own_estimator.md).
struct AdapterConfig {
  std::string name = "external";  ///< of the method
  std::string command;            ///< its words, with placeholders in braces; must be stated
  /// Prints the version on its first line; empty: not asked for.
  std::string version_command;
  /// Names of placeholders and what they stand for, relative to the adapter's file.
  std::map<std::string, std::filesystem::path> files;
  std::map<std::string, std::string> environment;  ///< with placeholders, too
  HandoverEvents events = HandoverEvents::kText;
  StampUnit event_unit = StampUnit::kMicroseconds;  ///< of h5 and csv
  double groundtruth_start_s = 0;                   ///< of true poses are handed over; 0: none
  AdapterOutput output;
  double timeout_s = 3600;  ///< of one repetition
  std::uint64_t seed = 1;
};

void describe(config::Fields& fields, AdapterConfig& config);

}  // namespace saccade
