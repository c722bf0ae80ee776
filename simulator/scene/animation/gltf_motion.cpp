#include "simulator/scene/animation/gltf_motion.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"

namespace saccade {
namespace {

using nlohmann::json;

/// A member, or null.
const json& member(const json& object, const char* key) {
  static const json kNone;
  return object.is_object() && object.contains(key) ? object[key] : kNone;
}

template <int n>
Eigen::Matrix<double, n, 1> vector_in(const json& object, const char* key,
                                      const Eigen::Matrix<double, n, 1>& initial) {
  const json& list = member(object, key);
  if (list.is_null()) return initial;
  Eigen::Matrix<double, n, 1> vector;
  for (int i = 0; i < n; ++i) vector[i] = list.at(static_cast<std::size_t>(i)).get<double>();
  return vector;
}

std::array<double, 16> parent_from_node(const json& node) {
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  if (!member(node, "matrix").is_null()) {
    const auto numbers = vector_in<16>(node, "matrix", Eigen::Matrix<double, 16, 1>::Zero());
    transform.matrix() = Eigen::Map<const Eigen::Matrix4d>(numbers.data());  // both by columns
  } else {
    const auto rotation = vector_in<4>(node, "rotation", {0, 0, 0, 1});
    const Eigen::Quaterniond turn(rotation[3], rotation[0], rotation[1], rotation[2]);
    transform.translation() = vector_in<3>(node, "translation", {0, 0, 0});
    transform.linear() =
        turn.normalized().toRotationMatrix() * vector_in<3>(node, "scale", {1, 1, 1}).asDiagonal();
  }
  std::array<double, 16> columns;
  std::copy_n(transform.matrix().data(), columns.size(), columns.begin());
  return columns;
}

class MotionReader {
 public:
  explicit MotionReader(const GltfFile& file) : file_(file) {}

  [[nodiscard]] GltfMotion read() {
    const auto scene = file_.document().value("scene", std::size_t{0});
    visit_all(member(file_.item("scenes", scene), "nodes"));
    for (const json& animation : member(file_.document(), "animations"))
      motion_.animations.push_back(read(animation));
    return std::move(motion_);
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw InputError(file_.source_name(), problem);
  }

  /// Nodes in the order of the file, each before its children; without recursion, for a file may
  /// hang as many below each other as it likes.
  void visit_all(const json& roots) {
    std::vector<std::pair<std::size_t, std::int32_t>>
        open;  // with their parents, the next one last
    const auto add = [&](const json& nodes, std::int32_t parent) {
      const std::size_t first = open.size();
      for (const json& node : nodes) open.emplace_back(node.get<std::size_t>(), parent);
      std::reverse(open.begin() + static_cast<std::ptrdiff_t>(first), open.end());
    };
    add(roots, -1);
    while (!open.empty()) {
      const auto [index, parent] = open.back();
      open.pop_back();
      const json& children = visit(index, parent);
      add(children, static_cast<std::int32_t>(motion_.tree_index.at(index)));
    }
  }

  /// Returns its children.
  const json& visit(std::size_t index, std::int32_t parent) {
    const json& node = file_.item("nodes", index);
    if (!node.is_object()) fail(fmt::format("it has no node {}", index));
    const auto own = static_cast<std::uint32_t>(motion_.tree.size());
    if (!motion_.tree_index.emplace(index, own).second)
      fail(fmt::format("its node {} has two parents", index));
    motion_.tree.push_back({node.value("name", ""), parent, parent_from_node(node)});
    const json& camera = member(node, "camera");
    if (!camera.is_null()) add_camera(camera.get<std::size_t>(), index, node);
    return member(node, "children");
  }

  void add_camera(std::size_t index, std::size_t node_index, const json& node) {
    const json& stated = file_.item("cameras", index);
    if (!stated.is_object()) fail(fmt::format("it has no camera {}", index));
    ModelCamera camera;
    camera.name = node.value("name", "");
    if (camera.name.empty()) camera.name = stated.value("name", "");
    if (camera.name.empty()) camera.name = fmt::format("camera {}", index);
    camera.node = static_cast<std::int32_t>(motion_.tree_index.at(node_index));
    camera.forward = {0, 0, -1};
    const json& lens = member(stated, "perspective");
    if (lens.is_object()) {
      camera.vertical_fov_rad = lens.at("yfov").get<double>();
      camera.horizontal_fov_rad =
          2 * std::atan(std::tan(0.5 * camera.vertical_fov_rad) * lens.value("aspectRatio", 1.0));
    }
    motion_.cameras.push_back(std::move(camera));
  }

  [[nodiscard]] ModelAnimation read(const json& stated) const {
    ModelAnimation animation;
    animation.name = stated.value("name", "");
    for (const json& channel : member(stated, "channels")) add_channel(stated, channel, animation);
    for (const ModelChannel& channel : animation.channels)
      for (const ModelTrack* track : {&channel.translation, &channel.rotation, &channel.scale})
        if (!track->times_s.empty())
          animation.duration_s = std::max(animation.duration_s, track->times_s.back());
    return animation;
  }

  void add_channel(const json& animation, const json& channel, ModelAnimation& target) const {
    const json& aim = channel.at("target");
    const json& node = member(aim, "node");
    const std::string path = aim.value("path", "");
    if (node.is_null() || path == "weights") return;  // morph targets are not shown
    const auto known = motion_.tree_index.find(node.get<std::size_t>());
    if (known == motion_.tree_index.end()) return;  // of another scene of the file
    auto place = std::ranges::find(target.channels, known->second, &ModelChannel::node);
    if (place == target.channels.end())
      place = target.channels.insert(place, ModelChannel{known->second, {}, {}, {}});
    if (path != "translation" && path != "rotation" && path != "scale")
      fail(fmt::format("its animation '{}' moves '{}', which no node has", target.name, path));
    (path == "translation" ? place->translation
     : path == "rotation"  ? place->rotation
                           : place->scale) = track(animation, channel.at("sampler"), target.name);
  }

  [[nodiscard]] ModelTrack track(const json& animation, const json& index,
                                 const std::string& name) const {
    const json& samplers = member(animation, "samplers");
    const auto k = index.get<std::size_t>();
    if (!samplers.is_array() || k >= samplers.size())
      fail(fmt::format("a channel of its animation '{}' has the sampler {}, of {}", name, k,
                       samplers.size()));
    const std::string kind = samplers[k].value("interpolation", "LINEAR");
    ModelTrack track;
    track.interpolation = kind == "STEP"          ? KeyInterpolation::kStep
                          : kind == "CUBICSPLINE" ? KeyInterpolation::kCubic
                                                  : KeyInterpolation::kLinear;
    const auto numbers = [&](const char* key) {
      const std::vector<float> floats = file_.accessor(samplers[k].at(key).get<std::size_t>());
      return std::vector<double>(floats.begin(), floats.end());
    };
    track.times_s = numbers("input");
    track.values = numbers("output");
    return track;
  }

  const GltfFile& file_;
  GltfMotion motion_;
};

/// The node that assimp calls by its index; -1: none of the file's.
std::int32_t node_called(const std::string& name, const GltfMotion& motion) {
  std::size_t index = 0;
  const char* const end = name.data() + name.size();
  const auto [stop, error] = std::from_chars(name.data(), end, index);
  if (error != std::errc() || stop != end) return -1;
  const auto known = motion.tree_index.find(index);
  return known == motion.tree_index.end() ? -1 : static_cast<std::int32_t>(known->second);
}

}  // namespace

GltfMotion read_gltf_motion(const GltfFile& file) {
  try {
    return MotionReader(file).read();
  } catch (const json::exception& error) {
    throw InputError(file.source_name(),
                     std::string("its animations cannot be read: ") + error.what());
  }
}

void take_gltf_motion(const GltfFile& file, Model& model) {
  GltfMotion motion = read_gltf_motion(file);
  for (ModelInstance& instance : model.instances) {
    const std::int32_t node = node_called(model.tree[instance.tree_node].name, motion);
    if (node < 0) throw InputError(file.source_name(), "its meshes do not fit its nodes");
    instance.tree_node = static_cast<std::uint32_t>(node);
    model.nodes[instance.node] = motion.tree[instance.tree_node].name;
  }
  for (ModelPart& part : model.parts)
    for (ModelBone& bone : part.bones) {
      bone.node = node_called(bone.name, motion);
      if (bone.node >= 0) bone.name = motion.tree[static_cast<std::size_t>(bone.node)].name;
    }
  model.tree = std::move(motion.tree);
  model.animations = std::move(motion.animations);
  model.cameras = std::move(motion.cameras);
}

}  // namespace saccade
