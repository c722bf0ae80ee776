#include "simulator/scene/animation/node_animation.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "core/check.h"
#include "core/config/suggest.h"
#include "core/error.h"
#include "simulator/scene/animation/key_track.h"

namespace saccade {
namespace {

const ModelTrack* tracks_of(const ModelChannel& channel, std::size_t k) {
  return std::array{&channel.translation, &channel.rotation, &channel.scale}[k];
}

/// "0 'walk', 1 'run'".
std::string list_of(std::span<const ModelAnimation> animations) {
  std::string text;
  for (std::size_t i = 0; i < animations.size(); ++i)
    text += fmt::format("{}{} '{}'", i == 0 ? "" : ", ", i, animations[i].name);
  return text;
}

std::size_t index_of(std::span<const ModelAnimation> animations, const std::string& wanted) {
  if (wanted.empty()) return 0;
  for (std::size_t i = 0; i < animations.size(); ++i)
    if (animations[i].name == wanted) return i;
  std::size_t index = animations.size();
  const char* const end = wanted.data() + wanted.size();
  const auto [stop, error] = std::from_chars(wanted.data(), end, index);
  return error == std::errc() && stop == end ? index : animations.size();
}

}  // namespace

NodeAnimation::NodeAnimation(std::span<const ModelNode> tree, const ModelAnimation* animation)
    : tree_(tree), channels_(tree.size()), rests_(tree.size()) {
  if (animation == nullptr) return;
  for (const ModelChannel& channel : animation->channels) {
    SACCADE_CHECK(channel.node < tree.size());
    channels_[channel.node] = &channel;
    const Eigen::Affine3d rest = affine_of(tree[channel.node].parent_from_node);
    Eigen::Matrix3d axes = rest.linear();
    Eigen::Vector3d scale = axes.colwise().norm();
    if (axes.determinant() < 0) scale.x() = -scale.x();
    for (int k = 0; k < 3; ++k)
      axes.col(k) = scale[k] != 0 ? Eigen::Vector3d(axes.col(k) / scale[k])
                                  : Eigen::Vector3d(Eigen::Vector3d::Unit(k));
    rests_[channel.node] = {rest.translation(), scale, Eigen::Quaterniond(axes).normalized()};
  }
}

Eigen::Affine3d NodeAnimation::parent_from_node(std::size_t node, double t_s) const {
  const ModelChannel* const channel = channels_[node];
  if (channel == nullptr) return affine_of(tree_[node].parent_from_node);
  const Rest& rest = rests_[node];
  const auto vector = [t_s](const ModelTrack& track, const Eigen::Vector3d& otherwise) {
    return track.times_s.empty() ? otherwise : vector_at(track, t_s);
  };
  const Eigen::Quaterniond rotation =
      channel->rotation.times_s.empty() ? rest.rotation : rotation_at(channel->rotation, t_s);
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  transform.translation() = vector(channel->translation, rest.translation);
  transform.linear() =
      rotation.toRotationMatrix() * vector(channel->scale, rest.scale).asDiagonal();
  return transform;
}

std::vector<Eigen::Affine3d> NodeAnimation::file_from_nodes(double t_s) const {
  std::vector<Eigen::Affine3d> file_from_nodes;
  file_from_nodes.reserve(tree_.size());
  for (std::size_t i = 0; i < tree_.size(); ++i) {
    const std::int32_t parent = tree_[i].parent;
    const Eigen::Affine3d own = parent_from_node(i, t_s);
    file_from_nodes.push_back(parent < 0 ? own
                                         : file_from_nodes[static_cast<std::size_t>(parent)] * own);
  }
  return file_from_nodes;
}

std::vector<bool> NodeAnimation::moved_nodes() const {
  std::vector<bool> moved(tree_.size());
  for (std::size_t i = 0; i < tree_.size(); ++i)
    moved[i] = channels_[i] != nullptr ||
               (tree_[i].parent >= 0 && moved[static_cast<std::size_t>(tree_[i].parent)]);
  return moved;
}

std::vector<double> NodeAnimation::key_times_s(const std::vector<bool>& nodes) const {
  std::vector<bool> above = nodes;
  for (std::size_t i = tree_.size(); i-- > 0;)
    if (above[i] && tree_[i].parent >= 0) above[static_cast<std::size_t>(tree_[i].parent)] = true;
  std::vector<double> times_s;
  for (std::size_t i = 0; i < tree_.size(); ++i) {
    if (!above[i] || channels_[i] == nullptr) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::vector<double>& keys = tracks_of(*channels_[i], k)->times_s;
      times_s.insert(times_s.end(), keys.begin(), keys.end());
    }
  }
  std::ranges::sort(times_s);
  times_s.erase(std::unique(times_s.begin(), times_s.end()), times_s.end());
  return times_s;
}

std::string problem_of(const ModelAnimation& animation) {
  if (animation.channels.empty()) return "has no channel: it moves no node of the file";
  if (!(animation.duration_s > 0))
    return fmt::format("lasts {:.6g} s; a motion needs more than 0", animation.duration_s);
  for (const ModelChannel& channel : animation.channels)
    for (std::size_t k = 0; k < 3; ++k)
      if (!is_valid(*tracks_of(channel, k), k == 1 ? 4 : 3))
        return fmt::format(
            "has a channel of node {} whose keys are not finite values at increasing times",
            channel.node);
  return {};
}

const ModelAnimation& find_animation(std::span<const ModelAnimation> animations,
                                     const std::string& wanted, const std::string& source_name) {
  if (animations.empty()) throw InputError(source_name, "holds no animation");
  const std::size_t index = index_of(animations, wanted);
  if (index >= animations.size()) {
    std::vector<std::string> names;
    for (const ModelAnimation& animation : animations) names.push_back(animation.name);
    const auto meant = config::nearest(wanted, names);
    throw InputError(
        source_name,
        fmt::format("holds no animation '{}'{}; its animations: {}", wanted,
                    meant ? fmt::format("; did you mean '{}'?", *meant) : "", list_of(animations)));
  }
  const std::string problem = problem_of(animations[index]);
  if (!problem.empty())
    throw InputError(source_name, fmt::format("its animation {} '{}' {}", index,
                                              animations[index].name, problem));
  return animations[index];
}

}  // namespace saccade
