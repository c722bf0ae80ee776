#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "eval/calibration/sensor_fit.h"
#include "eval/table/table.h"

namespace saccade {

/// A stretch as it was recorded and as the calibrated sensor repeats it.
struct RepeatedStretch {
  std::string name;
  SensorSize size;
  Events recorded, simulated;
  StreamDistance distance;
};

/// What a calibration found, for people.
struct CalibrationSummary {
  SensorFile sensor;
  std::vector<RepeatedStretch> stretches;  ///< none where nothing could be simulated again
  std::vector<HeldOutFold> folds;
  std::vector<std::string> remarks;
  std::string command;
};

/// Parameter, value, interval and what it rests on; what is not known as well.
[[nodiscard]] Table parameter_table(const SensorFile& sensor);
/// Real beside simulated, with the distance in each statistic.
[[nodiscard]] Table distance_table(const CalibrationSummary& summary);
/// How each half of the time is predicted from the other one.
[[nodiscard]] Table fold_table(const CalibrationSummary& summary);

/// One self-contained page: these tables, rates over time, gaps and maps of the events.
void write_calibration_page(const CalibrationSummary& summary, const std::filesystem::path& file);

}  // namespace saccade
