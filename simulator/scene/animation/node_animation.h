#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "simulator/scene/mesh/model.h"

namespace saccade {

/// Of a model's transform.
[[nodiscard]] inline Eigen::Affine3d affine_of(const std::array<double, 16>& columns) {
  return Eigen::Affine3d(Eigen::Map<const Eigen::Matrix4d>(columns.data()));
}

/// Where the nodes of a model are at any time of one of its animations. Thread-safe.
class NodeAnimation {
 public:
  /// `animation`: nullptr: nothing moves. Both outlive this. The animation is valid (problem_of()).
  NodeAnimation(std::span<const ModelNode> tree, const ModelAnimation* animation);

  /// Of all nodes, in the order of the tree.
  [[nodiscard]] std::vector<Eigen::Affine3d> file_from_nodes(double t_s) const;

  /// Which nodes it moves, with those below them.
  [[nodiscard]] std::vector<bool> moved_nodes() const;

  /// The times of the keys of the nodes above `nodes` and their own, in order, each once.
  [[nodiscard]] std::vector<double> key_times_s(const std::vector<bool>& nodes) const;

 private:
  /// What a node is made of where it has no keys.
  struct Rest {
    Eigen::Vector3d translation, scale;
    Eigen::Quaterniond rotation;
  };

  [[nodiscard]] Eigen::Affine3d parent_from_node(std::size_t node, double t_s) const;

  std::span<const ModelNode> tree_;
  std::vector<const ModelChannel*> channels_;  ///< of each node; nullptr: none
  std::vector<Rest> rests_;                    ///< of the nodes with channels
};

/// What is wrong with an animation: "" where it can be played.
[[nodiscard]] std::string problem_of(const ModelAnimation& animation);

/// An animation of a model: by its name or index, or the first. Throws InputError with `source_name` that
/// names the known ones, and for one that cannot be played.
[[nodiscard]] const ModelAnimation& find_animation(std::span<const ModelAnimation> animations,
                                                   const std::string& wanted,
                                                   const std::string& source_name);

}  // namespace saccade
