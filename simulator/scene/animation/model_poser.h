#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "simulator/scene/mesh/model.h"

namespace saccade {

/// The vertices and normals of a model, instance after instance, in the file's coordinates.
struct ModelPose {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3d> normals;  ///< unit, or zero where there is none
};

/// Places the vertices of a model where its nodes are: those of a part with bones by linear blend
/// skinning,
///   v_file = sum_b w_b file_from_node_b bone_from_part_b v,   sum_b w_b = 1,
/// all others with the node of their instance. Weights that do not sum to one are scaled to do so;
/// vertices without any move with the instance. Thread-safe.
class ModelPoser {
 public:
  /// `model` outlives this. Throws InputError with `source_name` that names a bone without a node,
  /// or with a weight that is negative or not finite.
  ModelPoser(const Model& model, const std::string& source_name);

  enum class Normals { kNone, kPosed };
  /// `file_from_nodes`: of the model's tree. With kNone the normals stay empty.
  [[nodiscard]] ModelPose pose(std::span<const Eigen::Affine3d> file_from_nodes,
                               Normals normals = Normals::kPosed) const;

  /// Nodes that move a vertex.
  [[nodiscard]] std::vector<bool> nodes() const;
  /// Whether some weights had to be scaled by more than a thousandth.
  [[nodiscard]] bool has_scaled_weights() const { return has_scaled_weights_; }

 private:
  using BlendMatrix = Eigen::Matrix<double, 3, 4>;
  struct Influence {
    std::uint32_t bone;
    double weight;
  };
  /// Of the vertices of a part: those of vertex i from first[i] to first[i + 1].
  struct Skin {
    std::vector<std::uint32_t> first;
    std::vector<Influence> influences;
  };

  /// Places vertex `i` of an instance, the `at`-th of the pose.
  void pose_vertex(const ModelPart& part, const Skin& skin, std::size_t i,
                   const Eigen::Affine3d& file_from_instance,
                   std::span<const BlendMatrix> file_from_bones, std::size_t at,
                   ModelPose& pose) const;
  [[nodiscard]] Skin skin_of(const ModelPart& part, const std::string& source_name);

  const Model& model_;
  std::vector<Skin> skins_;  ///< of the parts; empty: none
  bool has_scaled_weights_ = false;
};

}  // namespace saccade
