#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "eval/recording.h"
#include "simulator/replica/replica.h"

namespace saccade {

/// How a recording is repeated by simulation.
struct ReplicaOptions {
  enum class Motion { kAuto, kPoses, kImu, kEvents };
  enum class Tone { kAuto, kSrgb, kLinear };

  RecordingPart part;
  Motion motion = Motion::kAuto;
  Tone tone = Tone::kAuto;
  std::optional<double> depth_m;  ///< default: the median of the nearest depth map
  std::optional<double> log_eps;  ///< default: dataset.yaml's, else kRecordedLogEps
  int stretches = 3;              ///< at most
  double stretch_s = 0.2;         ///< the longest
};

/// Of recorded frames, whose black is no darkness: light that a pixel takes its dark current for,
/// beside a white of 1.
constexpr double kRecordedLogEps = 0.02;

/// A stretch of a recording, at one of its frames.
struct ReplicaStretch {
  std::string name;  ///< "walls at 0.125 s"
  ReplicaSource source;
  ImageU8 comparable;  ///< comparable_pixels()
  Events events;       ///< of these pixels, times from the stretch's begin
};

/// Stretches around evenly spaced frames of a dataset folder, each so short that at least
/// kLeastComparable of the pixels can be compared. None, with a line in `remarks` that says why, where
/// the recording has no frames, no motion that can be found, or translates at unknown depth.
[[nodiscard]] std::vector<ReplicaStretch> replica_stretches(const std::filesystem::path& recording,
                                                            const ReplicaOptions& options,
                                                            std::vector<std::string>& remarks);

}  // namespace saccade
