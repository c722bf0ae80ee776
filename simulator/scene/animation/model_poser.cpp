#include "simulator/scene/animation/model_poser.h"

#include <fmt/format.h>

#include <cmath>

#include <Eigen/LU>

#include "core/error.h"
#include "simulator/scene/animation/node_animation.h"

namespace saccade {
namespace {

/// Weights in single precision, or in eighths of a byte, sum to one within this.
constexpr double kWeightTolerance = 1e-3;

Eigen::Vector3d vector_of(const std::array<float, 3>& v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

Eigen::Vector3d turned(const Eigen::Matrix3d& normal_matrix, const Eigen::Vector3d& normal) {
  const Eigen::Vector3d result = normal_matrix * normal;
  const double length = result.norm();
  if (!(length > 0) || !std::isfinite(length)) return Eigen::Vector3d::Zero();
  return result / length;
}

/// Of a linear map: its inverse, transposed, up to a factor, also where it flattens.
Eigen::Matrix3d normal_matrix_of(const Eigen::Matrix3d& m) {
  Eigen::Matrix3d cofactors;
  cofactors << m.col(1).cross(m.col(2)), m.col(2).cross(m.col(0)), m.col(0).cross(m.col(1));
  return m.determinant() < 0 ? Eigen::Matrix3d(-cofactors) : cofactors;
}

}  // namespace

ModelPoser::ModelPoser(const Model& model, const std::string& source_name) : model_(model) {
  for (const ModelPart& part : model.parts) skins_.push_back(skin_of(part, source_name));
}

ModelPoser::Skin ModelPoser::skin_of(const ModelPart& part, const std::string& source_name) {
  Skin skin;
  if (part.bones.empty()) return skin;
  skin.first.resize(part.vertices.size() + 1);
  std::vector<double> sums(part.vertices.size());
  for (const ModelBone& bone : part.bones) {
    if (bone.node < 0 && !bone.vertices.empty())
      throw InputError(source_name, fmt::format("its bone '{}' is no node of the file", bone.name));
    for (std::size_t k = 0; k < bone.vertices.size(); ++k) {
      const auto weight = static_cast<double>(bone.weights[k]);
      if (!(weight >= 0 && std::isfinite(weight)))
        throw InputError(source_name,
                         fmt::format("vertex {} has the weight {} of its bone '{}'; weights are "
                                     "at least 0",
                                     bone.vertices[k], weight, bone.name));
      ++skin.first[bone.vertices[k] + 1];
      sums[bone.vertices[k]] += weight;
    }
  }
  for (std::size_t i = 1; i < skin.first.size(); ++i) skin.first[i] += skin.first[i - 1];
  skin.influences.resize(skin.first.back());
  std::vector<std::uint32_t> next(skin.first.begin(), skin.first.end() - 1);
  for (std::uint32_t b = 0; b < part.bones.size(); ++b)
    for (std::size_t k = 0; k < part.bones[b].vertices.size(); ++k) {
      const std::uint32_t vertex = part.bones[b].vertices[k];
      const double sum = sums[vertex];
      if (sum > 0 && std::abs(sum - 1) > kWeightTolerance) has_scaled_weights_ = true;
      const double weight = static_cast<double>(part.bones[b].weights[k]);
      skin.influences[next[vertex]++] = {b, sum > 0 ? weight / sum : 0};
    }
  return skin;
}

ModelPose ModelPoser::pose(std::span<const Eigen::Affine3d> file_from_nodes,
                           Normals normals) const {
  std::size_t count = 0;
  for (const ModelInstance& instance : model_.instances)
    count += model_.parts[instance.part].vertices.size();
  ModelPose pose;
  pose.vertices.resize(count);
  if (normals == Normals::kPosed) pose.normals.resize(count, Eigen::Vector3d::Zero());
  std::size_t first = 0;
  for (const ModelInstance& instance : model_.instances) {
    const ModelPart& part = model_.parts[instance.part];
    const Eigen::Affine3d& file_from_instance = file_from_nodes[instance.tree_node];
    std::vector<BlendMatrix> file_from_bones;
    for (const ModelBone& bone : part.bones)
      file_from_bones.push_back(bone.node < 0
                                    ? file_from_instance.affine()
                                    : (file_from_nodes[static_cast<std::size_t>(bone.node)] *
                                       affine_of(bone.bone_from_part))
                                          .affine());
    for (std::size_t i = 0; i < part.vertices.size(); ++i)
      pose_vertex(part, skins_[instance.part], i, file_from_instance, file_from_bones, first + i,
                  pose);
    first += part.vertices.size();
  }
  return pose;
}

void ModelPoser::pose_vertex(const ModelPart& part, const Skin& skin, std::size_t i,
                             const Eigen::Affine3d& file_from_instance,
                             std::span<const BlendMatrix> file_from_bones, std::size_t at,
                             ModelPose& pose) const {
  BlendMatrix blend = BlendMatrix::Zero();
  double total = 0;
  if (!skin.first.empty())
    for (std::uint32_t k = skin.first[i]; k < skin.first[i + 1]; ++k) {
      blend += skin.influences[k].weight * file_from_bones[skin.influences[k].bone];
      total += skin.influences[k].weight;
    }
  if (!(total > 0)) blend = file_from_instance.affine();
  pose.vertices[at] = blend.leftCols<3>() * vector_of(part.vertices[i]) + blend.col(3);
  if (!pose.normals.empty() && !part.normals.empty())
    pose.normals[at] = turned(normal_matrix_of(blend.leftCols<3>()), vector_of(part.normals[i]));
}

std::vector<bool> ModelPoser::nodes() const {
  std::vector<bool> nodes(model_.tree.size());
  for (const ModelInstance& instance : model_.instances) {
    const ModelPart& part = model_.parts[instance.part];
    nodes[instance.tree_node] = nodes[instance.tree_node] || part.bones.empty();
    for (const ModelBone& bone : part.bones)
      if (bone.node >= 0 && !bone.vertices.empty())
        nodes[static_cast<std::size_t>(bone.node)] = true;
  }
  return nodes;
}

}  // namespace saccade
