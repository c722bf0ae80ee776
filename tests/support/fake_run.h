#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "core/event.h"

namespace saccade::testing {

/// Writes the dataset of corner_world() under corner_motion(): events, frames, depth maps and
/// ground truth over `duration_s`, with `width` pixels on 4:3. Of the events those for which `is_kept` says so, in order of
/// time; all by default.
void write_corner_dataset(const std::filesystem::path& folder, const std::string& name,
                          double duration_s, int width = 240,
                          const std::function<bool(const Event&)>& is_kept = {});

/// How a fake estimator errs.
struct FakeErrors {
  double slow_m = 0.004;    ///< amplitude of a slow wander
  double noise_m = 0.0008;  ///< sigma per pose and axis
  double slow_deg = 0.2;
  double noise_deg = 0.04;
  double rate_hz = 700;      ///< poses per second
  double lost_from_s = -1;   ///< no poses from here on ...
  double lost_until_s = -1;  ///< ... to here
};

/// Writes a run folder "by" the module `track` over that dataset: run.yaml, trajectory.txt,
/// poses.csv, timing.json and map.ply (edge points of the first frame with their depth).
/// `configuration`: name of the file that it states.
void write_fake_run(const std::filesystem::path& folder, const std::filesystem::path& dataset,
                    const FakeErrors& errors = {}, const std::string& configuration = "accurate");

/// Makes such a run one of odometry: `count` keyframes every 20 ms from 20 ms on, in force from 10
/// ms after their view on and each alone, with the true depth and log intensity and an equal part
/// of the map.
void add_fake_keyframes(const std::filesystem::path& run, int count);

}  // namespace saccade::testing
