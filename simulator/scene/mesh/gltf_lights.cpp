#include "simulator/scene/mesh/gltf_lights.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "core/config/suggest.h"
#include "core/error.h"

namespace saccade {
namespace {

using nlohmann::json;

constexpr const char* kLightExtension = "KHR_lights_punctual";

/// A member, or null.
const json& part_of(const json& object, const char* key) {
  static const json kNone;
  return object.is_object() && object.contains(key) ? object[key] : kNone;
}

template <int n>
Eigen::Matrix<double, n, 1> vector_in(const json& object, const char* key,
                                      const Eigen::Matrix<double, n, 1>& initial) {
  const json& list = part_of(object, key);
  if (list.is_null()) return initial;
  Eigen::Matrix<double, n, 1> vector;
  for (int i = 0; i < n; ++i) vector[i] = list.at(static_cast<std::size_t>(i)).get<double>();
  return vector;
}

Eigen::Affine3d parent_from_node(const json& node) {
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  if (!part_of(node, "matrix").is_null()) {
    const auto numbers = vector_in<16>(node, "matrix", {});
    transform.matrix() = Eigen::Map<const Eigen::Matrix4d>(numbers.data());  // both by columns
    return transform;
  }
  const auto rotation = vector_in<4>(node, "rotation", {0, 0, 0, 1});
  const Eigen::Quaterniond turn(rotation[3], rotation[0], rotation[1], rotation[2]);
  transform.translation() = vector_in<3>(node, "translation", {0, 0, 0});
  transform.linear() =
      turn.normalized() * vector_in<3>(node, "scale", {1, 1, 1}).asDiagonal().toDenseMatrix();
  return transform;
}

/// The lights of a file, node by node.
class LightReader {
 public:
  LightReader(const GltfFile& file, ColourChannel channel)
      : file_(file),
        channel_(channel),
        stated_(
            part_of(part_of(part_of(file.document(), "extensions"), kLightExtension), "lights")),
        is_visited_(part_of(file.document(), "nodes").size(), false) {}

  [[nodiscard]] std::vector<LightOptions> read() {
    const auto scene = file_.document().value("scene", std::size_t{0});
    for (const json& root : part_of(file_.item("scenes", scene), "nodes"))
      visit(root.get<std::size_t>(), Eigen::Affine3d::Identity());
    return std::move(lights_);
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw InputError(file_.source_name(), problem);
  }

  void visit(std::size_t index, const Eigen::Affine3d& file_from_parent) {
    const json& node = file_.item("nodes", index);
    if (!node.is_object()) fail(fmt::format("it has no node {}", index));
    if (is_visited_[index]) fail(fmt::format("its node {} has two parents", index));
    is_visited_[index] = true;
    const Eigen::Affine3d file_from_node = file_from_parent * parent_from_node(node);
    const json& use = part_of(part_of(part_of(node, "extensions"), kLightExtension), "light");
    if (!use.is_null()) lights_.push_back(light(use.get<std::size_t>(), file_from_node));
    for (const json& child : part_of(node, "children"))
      visit(child.get<std::size_t>(), file_from_node);
  }

  [[nodiscard]] LightOptions light(std::size_t index, const Eigen::Affine3d& file_from_node) const {
    if (!stated_.is_array() || index >= stated_.size())
      fail(fmt::format("a node has the light {}, of {}", index, stated_.size()));
    const json& stated = stated_[index];
    const std::string name = fmt::format("its light {} '{}'", index, stated.value("name", ""));
    LightOptions light;
    light.type = type_of(stated, name);
    light.position = file_from_node.translation();
    light.direction = -file_from_node.linear().col(2);
    if (!(light.direction.norm() > 0) || !light.direction.allFinite() ||
        !light.position.allFinite())
      fail(name + " is at a node whose transform is singular");
    light.direction.normalize();
    light.intensity = intensity_of(stated, name);
    if (light.type == LightType::kSpot) take_cone(stated, name, light);
    return light;
  }

  [[nodiscard]] LightType type_of(const json& stated, const std::string& name) const {
    const std::vector<std::pair<std::string, LightType>> types{
        {"directional", LightType::kDirectional},
        {"point", LightType::kPoint},
        {"spot", LightType::kSpot}};
    const std::string type = stated.value("type", "");
    std::vector<std::string> names;
    for (const auto& [known, kind] : types) {
      if (type == known) return kind;
      names.push_back(known);
    }
    fail(fmt::format("{} has the type '{}': {}", name, type,
                     config::suggestion(type, names, "types")));
  }

  [[nodiscard]] double intensity_of(const json& stated, const std::string& name) const {
    const double intensity = stated.value("intensity", 1.0);
    if (!(intensity >= 0 && std::isfinite(intensity)))
      fail(fmt::format("{} has the intensity {}, which must be at least 0", name, intensity));
    const Eigen::Vector3d colour = vector_in<3>(stated, "color", {1, 1, 1});
    if (!(colour.minCoeff() >= 0 && colour.allFinite()))
      fail(name + " has a colour with parts below 0");
    const Eigen::Vector3f c = colour.cast<float>();
    return intensity * static_cast<double>(in_channel(channel_, c[0], c[1], c[2]));
  }

  void take_cone(const json& stated, const std::string& name, LightOptions& light) const {
    const json& cone = part_of(stated, "spot");
    const auto angle_deg = [&](const char* key, double initial) {
      const json& angle = part_of(cone, key);
      return (angle.is_null() ? initial : angle.get<double>()) * (180 / std::numbers::pi);
    };
    const double inner = angle_deg("innerConeAngle", 0);
    const double outer = angle_deg("outerConeAngle", std::numbers::pi / 4);
    constexpr double kRounding = 1e-4;  // pi / 2 in single precision
    if (!(inner >= 0 && inner <= outer && outer >= kLeastFalloff_deg && outer <= 90 + kRounding))
      fail(
          fmt::format("{} has cones of {:.6g} and {:.6g} degrees: innerConeAngle must be from 0 to "
                      "outerConeAngle, and that above 0 and at most pi / 2",
                      name, inner, outer));
    light.outer_angle_deg = std::min(outer, 90.0);
    light.inner_angle_deg = std::min(inner, light.outer_angle_deg - kLeastFalloff_deg);
  }

  const GltfFile& file_;
  ColourChannel channel_;
  const json& stated_;
  std::vector<bool> is_visited_;
  std::vector<LightOptions> lights_;
};

}  // namespace

std::vector<LightOptions> read_gltf_lights(const GltfFile& file, ColourChannel channel) {
  try {
    return LightReader(file, channel).read();
  } catch (const json::exception& error) {
    throw InputError(file.source_name(), std::string("its lights cannot be read: ") + error.what());
  }
}

}  // namespace saccade
