#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "core/config/fields.h"
#include "core/io/run/method_class.h"

namespace saccade {

enum class StampUnit { kSeconds, kMilliseconds, kMicroseconds, kNanoseconds };

/// The trajectory that an external program writes: a line for each pose, numbers separated by
/// blanks or commas; lines that begin with '#' and a first line of column names are skipped.
struct TrajectoryFormat {
  /// `t x y z qx qy qz qw`, or with the quaternion's w first (EuRoC).
  enum class Columns { kTum, kEuroc };
  enum class Convention { kWorldFromCamera, kCameraFromWorld };

  std::string file = "trajectory.txt";
  Columns columns = Columns::kTum;
  StampUnit timestamp_unit = StampUnit::kSeconds;
  Convention poses = Convention::kWorldFromCamera;
  double time_offset_s = 0;
};

/// Results of an external program, relative to {out}; an empty path: the program writes none.
struct AdapterOutput {
  TrajectoryFormat trajectory;
  std::string covariance, map, views;
  std::string events;  ///< of a simulator, which writes no trajectory
};

/// How to run an external estimator (docs/own_estimator.md).
struct AdapterConfig {
  std::string name = "external";
  std::string command;
  std::optional<std::filesystem::path> python;  ///< a method of the Python module, for `command`
  std::string version_command;
  std::map<std::string, std::filesystem::path> files;  ///< by placeholder
  std::string events = "txt";                          ///< ending of the file
  StampUnit event_unit = StampUnit::kMicroseconds;
  double truth_s = 0;                       ///< of the poses that are given at the start
  std::optional<MethodClass> method_class;  ///< nullopt: not known
  AdapterOutput output;
  double timeout_s = 3600;
  std::uint64_t seed = 1;
  std::optional<std::filesystem::path> container;  ///< image of Apptainer that it runs in
  std::string prepare;               ///< command that is run once before a submission's first run
  std::string licence;               ///< of the method, "MIT"
  std::string link;                  ///< where it is described
  std::optional<double> expected_s;  ///< that a second of recording takes, as its authors state
};

void describe(config::Fields& fields, AdapterConfig& config);

/// The command line that runs the program: `command`, or one that runs the method in `python`.
[[nodiscard]] std::string command_of(const AdapterConfig& config);

}  // namespace saccade
