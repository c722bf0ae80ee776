#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/io/run/keyframe_list.h"
#include "eval/depth_views.h"
#include "eval/image_views.h"
#include "eval/run_folder.h"

namespace saccade {

/// The keyframes of an odometry run: what each of them holds, and which were used when.
class KeyframeHistory {
 public:
  /// keyframes.yaml with views.yaml and map.ply of the folder; nullopt where it has no
  /// keyframes.yaml. Throws InputError where the files do not belong together.
  [[nodiscard]] static std::optional<KeyframeHistory> load(const RunFolder& run);

  /// At least one, in order of time.
  [[nodiscard]] std::span<const KeyframeEntry> keyframes() const { return keyframes_; }
  [[nodiscard]] const EstimatedView& depth(std::size_t keyframe) const;
  /// nullptr where the run made no image of it.
  [[nodiscard]] const ImageView* image(std::size_t keyframe) const;

  /// Index of the newest keyframe in force at `t_s`; before the first the first.
  [[nodiscard]] std::size_t in_force(double t_s) const;
  /// Edges [m, in the world] of the keyframes that make up the map at `t_s`.
  [[nodiscard]] std::vector<Eigen::Vector3f> map_at(double t_s) const;

 private:
  std::vector<KeyframeEntry> keyframes_;
  std::vector<EstimatedView> depths_;
  std::vector<ImageView> images_;
  std::vector<Eigen::Vector3f> edges_;    ///< of all keyframes
  std::vector<std::size_t> first_edges_;  ///< of each keyframe, and one past the last
};

}  // namespace saccade
