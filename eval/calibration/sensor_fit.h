#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/event.h"
#include "core/io/events/event_file.h"
#include "core/io/sensor_file.h"
#include "eval/calibration/stream_distance.h"
#include "eval/calibration/stream_moments.h"

namespace saccade {

/// A recording and what repeats it with another sensor.
struct RepeatedRecording {
  std::string name;
  SensorSize size;
  double duration_s = 0;
  Events recorded;  ///< of the pixels that are compared, times from 0
  /// The simulated events of the same pixels and time. Deterministic.
  std::function<Events(const SensorParameters&)> simulate;
};

struct SensorFitOptions {
  bool fits_refractory = true;  ///< else it stays where it starts
  bool fits_mismatch = true;    ///< else differences between neighbours do not count either
  bool fits_cutoff = true;
  /// Shorter gaps are left out of the comparison [us].
  double shortest_gap_us = 0;
  int iterations = 8;
};

/// What a parameter was found to be.
struct FittedParameter {
  std::string name;  ///< "contrast_on", "refractory.period_us", ...
  double value = 0;
  double low = 0, high = 0;  ///< 95 % interval
  /// Whether it lies within a factor of 1.5 of its value; else the data does not tell it.
  bool is_told = false;
};

/// How well what was found from one half of the time predicts the other half.
struct HeldOutFold {
  std::string recording;
  std::size_t fold = 0;  ///< that was held out
  SensorParameters sensor;
  StreamDistance distance;
};

struct SensorFit {
  SensorParameters sensor;
  std::vector<FittedParameter> parameters;
  std::vector<StreamDistance> distances;  ///< one for each recording
  std::vector<HeldOutFold> folds;
  int simulations = 0;  ///< of a recording
  bool has_converged = false;
};

/// Fits a sensor by simulated moments (McFadden, Econometrica 57(5), 1989): the parameters at which
/// the simulated StreamMoments are the recorded ones in weighted least squares, by Gauss and Newton
/// with derivatives by differences. A moment weighs as its
/// sampling error (a jackknife over blocks of the sensor) and the error that a replica has in any case
/// allow. One sensor for all recordings.
///
/// The intervals are a jackknife over the blocks of all recordings: what of the moments' differences
/// varies over the scene. What is wrong everywhere alike (black level, blur of the frame) is not in
/// them. `start`: contrast_on and contrast_off at least, and everything that is to be fitted.
[[nodiscard]] SensorFit fit_sensor(std::span<const RepeatedRecording> recordings,
                                   const SensorParameters& start, const SensorFitOptions& options);

}  // namespace saccade
