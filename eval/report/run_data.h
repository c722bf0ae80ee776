#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/io/dataset/dataset.h"
#include "eval/keyframe_history.h"
#include "eval/metrics/trajectory/reprojection.h"
#include "eval/run_folder.h"

namespace saccade {

/// A run with everything that the page says about it, with the scores that `eval` wrote, or
/// scored again where those are stale and its dataset is there.
struct RunData {
  std::string id;       ///< unique in the report, an HTML id
  std::string address;  ///< of its section, from the page of the report: "#run1", "runs/best.html"
  std::string dataset;  ///< name
  /// Module with its configuration's name, or what an external estimator is called; with what tells
  /// it from another of that name (tell_methods_apart).
  std::string method;
  RunFolder run;
  std::optional<Dataset> data;  ///< nullopt: the folder is gone, `missing` says why
  std::string missing;
  std::string stale;  ///< why it was scored again; empty: the scores are those of metrics.json
  Metrics facts;      ///< of the dataset: those of thesis table 8.1, as dataset.*
  Metrics metrics;
  TrajectoryScoreInput input;
  ScoredSamples samples;
  ErrorSeries errors;
  ReprojectionSeries reprojection;
  Similarity
      truth_from_estimate;  ///< brings `map` and the poses of `input` to where they are scored
  std::vector<Eigen::Vector3f> map;
  std::optional<KeyframeHistory> keyframes;  ///< of an odometry run
};

/// Reads the run folder and scores it where its scores are stale; `index` is its place on the page.
/// `with_reprojection`: with RunData::reprojection, which takes most of the time.
[[nodiscard]] RunData gather_run(const std::filesystem::path& folder, std::size_t index,
                                 bool with_reprojection = true);

/// The same without facts, keyframes and scores: what is drawn of its errors over time, for which
/// stale scores do not matter.
[[nodiscard]] RunData gather_errors(const std::filesystem::path& folder, std::size_t index);

/// refined_ratio.* of every run that has a run of refine beside it.
void compare_with_refined(std::vector<RunData>& runs);

/// Two configurations of one name are two methods: where runs of one dataset have the same method
/// with other values, the seed apart, the method is followed by the folder of its configuration
/// file, of equal values the first; where folders do not tell them apart, by a hash of the values.
void tell_methods_apart(std::vector<RunData>& runs);

/// dataset.{events,duration_s,mean_scene_depth_m,path_length_m}, as far as they are known.
[[nodiscard]] Metrics facts_of(const Dataset& dataset);

}  // namespace saccade
