#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/config/config.h"
#include "core/io/dataset/dataset.h"
#include "core/io/run/run_record.h"
#include "core/trajectory.h"
#include "estimator/run/run_request.h"
#include "estimator/tracking/tracker.h"

namespace saccade {

/// The run that is refined.
struct SourceRun {
  std::filesystem::path folder;
  RunRecord record;

  /// RunRequest::from. Throws InputError where none is named, where it holds no run, or one over
  /// another dataset.
  [[nodiscard]] static SourceRun open(const RunRequest& request, const Dataset& dataset);

  /// The request for its own part of the dataset, unless another one is asked for.
  [[nodiscard]] RunRequest within(const RunRequest& request) const;

  /// Its resolved configuration; a key that is not valid any more is an InputError.
  template <class Config>
  [[nodiscard]] Config config() const;

  /// The poses that it found, of poses.csv with the positions of trajectory.txt, as many as both
  /// state; lost ones too. Throws InputError where it holds fewer than four.
  [[nodiscard]] std::vector<TrackedPose> poses() const;

 private:
  [[nodiscard]] config::Document document() const;
};

/// The poses that are not lost, the first and last repeated at `start_s` and `end_s`. Throws InputError
/// naming `where` where fewer than four are left.
[[nodiscard]] std::vector<StampedPose> poses_not_lost(std::span<const TrackedPose> poses,
                                                      double start_s, double end_s,
                                                      const std::string& where);

template <class Config>
Config SourceRun::config() const {
  return config::read<Config>(document());
}

}  // namespace saccade
