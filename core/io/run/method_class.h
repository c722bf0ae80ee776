#pragma once

#include <set>
#include <string>

#include "core/config/fields.h"

namespace saccade {

/// What a method is given beside the camera's calibration. Poses, depth and map are the true ones:
/// of those that another run found, that run's inputs count.
enum class MethodInput {
  kEvents,
  kFrames,  ///< the grey frames of the recording
  kImu,     ///< the samples of the inertial sensor
  kStart,   ///< the poses of the first moments
  kMap,     ///< picture and depth of the scene, and the pose at which it starts
  kPoses,   ///< at all times
  kDepth,   ///< at all times
};

/// How far a method looks ahead, from little to much.
enum class Processing {
  /// A result depends on no measurement after its time, but for the rest of the frame of events of a
  /// tracker, which lasts milliseconds and is stamped with its mean time.
  kCausal,
  kFixedLag,  ///< results depend on, or are revised by, measurements of a limited time after them
  kBatch,     ///< every result depends on all measurements
};

/// Results are ranked among those of the same class alone.
struct MethodClass {
  std::set<MethodInput> inputs;
  Processing processing = Processing::kCausal;

  [[nodiscard]] bool operator==(const MethodClass&) const = default;
};

void describe(config::Fields& fields, MethodClass& method);

/// That of a method which continues another one's result: all inputs of both, and the later
/// processing.
[[nodiscard]] MethodClass merged(const MethodClass& a, const MethodClass& b);

/// "events + map".
[[nodiscard]] std::string inputs_text(const MethodClass& method);
/// "causal".
[[nodiscard]] std::string processing_text(const MethodClass& method);

}  // namespace saccade
