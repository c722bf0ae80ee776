#include "simulator/scene/animation/animation_sampler.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "simulator/scene/animation/model_poser.h"

namespace saccade {
namespace {

/// Poses hold so many vertices at most: 3 GB with their normals.
constexpr std::size_t kMostVertices = std::size_t{1} << 27U;
/// Keys nearer to each other are one [s].
constexpr double kSameKey_s = 1e-7;

double size_of(const ModelPose& pose) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : pose.vertices) box.extend(vertex);
  return box.diagonal().norm();
}

MeshAnimation::Vectors in_single_precision(const std::vector<Eigen::Vector3d>& vectors) {
  MeshAnimation::Vectors result;
  result.reserve(vectors.size());
  for (const Eigen::Vector3d& vector : vectors) result.push_back(vector.cast<float>());
  return result;
}

class Sampler {
 public:
  Sampler(const Model& model, const ModelAnimation& animation, const std::string& source_name)
      : poser_(model, source_name),
        nodes_(model.tree, &animation),
        animation_(animation),
        source_name_(source_name) {}

  [[nodiscard]] MeshAnimation sample() {
    check_motion();
    ModelPose before = pose(0);
    tolerance_ = kChordError * size_of(before);
    result_.name = animation_.name;
    result_.has_scaled_weights = poser_.has_scaled_weights();
    double before_s = 0;
    append(0, before);
    for (const double key_s : keys_s()) {
      ModelPose next = pose(key_s);
      refine(before_s, before, key_s, next);
      append(key_s, next);
      before = std::move(next);
      before_s = key_s;
    }
    return std::move(result_);
  }

 private:
  void check_motion() const {
    const std::vector<bool> moved = nodes_.moved_nodes();
    const std::vector<bool> shown = poser_.nodes();
    for (std::size_t i = 0; i < moved.size(); ++i)
      if (moved[i] && shown[i]) return;
    throw InputError(source_name_, fmt::format("its animation '{}' moves nothing that is visible",
                                               animation_.name));
  }

  /// After 0, up to the end.
  [[nodiscard]] std::vector<double> keys_s() const {
    std::vector<double> keys_s;
    for (const double key_s : nodes_.key_times_s(poser_.nodes())) {
      const double before_s = keys_s.empty() ? 0 : keys_s.back();
      if (key_s > before_s + kSameKey_s && key_s < animation_.duration_s - kSameKey_s)
        keys_s.push_back(key_s);
    }
    keys_s.push_back(animation_.duration_s);
    return keys_s;
  }

  [[nodiscard]] ModelPose pose(double t_s) const {
    return poser_.pose(nodes_.file_from_nodes(t_s));
  }

  void append(double t_s, const ModelPose& pose) {
    for (std::size_t i = 0; i < pose.vertices.size(); ++i)
      if (!pose.vertices[i].allFinite())
        throw InputError(source_name_,
                         fmt::format("its animation '{}' moves vertex {} to a place that is not "
                                     "finite at {:.6g} s",
                                     animation_.name, i, t_s));
    if ((result_.times_s.size() + 1) * pose.vertices.size() > kMostVertices)
      throw InputError(source_name_,
                       fmt::format("its animation '{}' of {:.6g} s and {} vertices is too long: "
                                   "its poses do not fit into memory",
                                   animation_.name, animation_.duration_s, pose.vertices.size()));
    result_.times_s.push_back(t_s);
    result_.vertices.push_back(in_single_precision(pose.vertices));
    result_.normals.push_back(in_single_precision(pose.normals));
  }

  /// Appends what is needed between two poses.
  void refine(double from_s, const ModelPose& from, double to_s, const ModelPose& to) {
    if (to_s - from_s <= kJump_s) return;
    const double middle_s = 0.5 * (from_s + to_s);
    const ModelPose middle = pose(middle_s);
    const auto is_near = [&](double fraction, const ModelPose& at) {
      for (std::size_t i = 0; i < at.vertices.size(); ++i) {
        const Eigen::Vector3d chord =
            from.vertices[i] + fraction * (to.vertices[i] - from.vertices[i]);
        if (!((at.vertices[i] - chord).norm() <= tolerance_)) return false;
      }
      return true;
    };
    const auto vertices_at = [&](double fraction) {
      return poser_.pose(nodes_.file_from_nodes(std::lerp(from_s, to_s, fraction)),
                         ModelPoser::Normals::kNone);
    };
    if (is_near(0.5, middle) && is_near(0.25, vertices_at(0.25)) &&
        is_near(0.75, vertices_at(0.75)))
      return;
    refine(from_s, from, middle_s, middle);
    append(middle_s, middle);
    refine(middle_s, middle, to_s, to);
  }

  ModelPoser poser_;
  NodeAnimation nodes_;
  const ModelAnimation& animation_;
  const std::string& source_name_;
  double tolerance_ = 0;
  MeshAnimation result_;
};

}  // namespace

MeshAnimation sample_animation(const Model& model, const ModelAnimation& animation,
                               const std::string& source_name) {
  return Sampler(model, animation, source_name).sample();
}

}  // namespace saccade
