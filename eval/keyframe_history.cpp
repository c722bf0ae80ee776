#include "eval/keyframe_history.h"

#include <fmt/core.h>

#include <algorithm>

#include "core/error.h"

namespace saccade {

std::optional<KeyframeHistory> KeyframeHistory::load(const RunFolder& run) {
  const std::filesystem::path list = run.folder / "keyframes.yaml";
  if (!std::filesystem::exists(list)) return std::nullopt;
  KeyframeHistory history;
  history.keyframes_ = read_keyframe_list(list);
  history.depths_ = load_depth_views(run.folder);
  history.images_ = load_image_views(run.folder);
  history.edges_ = run.load_map().positions;
  const std::size_t count = history.keyframes_.size();
  if (count == 0) throw InputError(list.string(), "holds no keyframe");
  if (history.depths_.size() != count)
    throw InputError(list.string(), fmt::format("holds {} keyframes, views.yaml {} with depth",
                                                count, history.depths_.size()));
  history.first_edges_ = {0};
  for (const KeyframeEntry& keyframe : history.keyframes_)
    history.first_edges_.push_back(history.first_edges_.back() +
                                   static_cast<std::size_t>(keyframe.edges));
  if (history.first_edges_.back() != history.edges_.size())
    throw InputError(list.string(),
                     fmt::format("states {} edges, map.ply holds {}", history.first_edges_.back(),
                                 history.edges_.size()));
  return history;
}

const EstimatedView& KeyframeHistory::depth(std::size_t keyframe) const {
  return depths_.at(keyframe);
}

const ImageView* KeyframeHistory::image(std::size_t keyframe) const {
  // Both times are read from the same line of views.yaml.
  const double t_s = depths_.at(keyframe).t_s;
  const auto at = std::find_if(images_.begin(), images_.end(),
                               [&](const ImageView& view) { return view.t_s == t_s; });
  return at == images_.end() ? nullptr : &*at;
}

std::size_t KeyframeHistory::in_force(double t_s) const {
  std::size_t newest = 0;
  for (std::size_t i = 1; i < keyframes_.size(); ++i)
    if (keyframes_[i].taken_s < t_s) newest = i;
  return newest;
}

std::vector<Eigen::Vector3f> KeyframeHistory::map_at(double t_s) const {
  std::vector<Eigen::Vector3f> map;
  for (const std::int64_t keyframe : keyframes_[in_force(t_s)].active) {
    const auto i = static_cast<std::size_t>(keyframe);
    map.insert(map.end(), edges_.begin() + static_cast<std::ptrdiff_t>(first_edges_[i]),
               edges_.begin() + static_cast<std::ptrdiff_t>(first_edges_[i + 1]));
  }
  return map;
}

}  // namespace saccade
