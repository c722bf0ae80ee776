#include "simulator/scene/mesh/gltf_instances.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

namespace saccade {
namespace {

using nlohmann::json;

constexpr const char* kExtension = "EXT_mesh_gpu_instancing";
/// Every place has triangles of its own, and a node in memory.
constexpr std::size_t kMostPlaces = 100'000;

/// What the extension states of a place, and as what a node states it.
struct PlacePart {
  const char* attribute;
  const char* key;
  std::size_t width;
};
constexpr PlacePart kPlaceParts[] = {
    {"TRANSLATION", "translation", 3}, {"ROTATION", "rotation", 4}, {"SCALE", "scale", 3}};

/// One child per place, in their order; nullopt where the node is no instanced mesh.
std::optional<std::vector<json>> children_of(const json& node, std::size_t index,
                                             const GltfAccess& access) {
  const json::json_pointer stated(std::string("/extensions/") + kExtension + "/attributes");
  if (!node.is_object() || !node.contains("mesh") || !node.contains(stated)) return std::nullopt;
  json child{{"mesh", node["mesh"]}};
  if (node.contains("name")) child["name"] = node["name"];
  std::optional<std::size_t> count;
  std::vector<json> children;
  for (const auto& [attribute, key, width] : kPlaceParts) {
    const json& attributes = node.at(stated);
    if (!attributes.contains(attribute)) continue;
    const std::vector<float> numbers =
        access.accessor(attributes.at(attribute).get<std::size_t>(), width);
    if (count && *count != numbers.size() / width)
      access.fail(fmt::format("the places of its node {} differ in number", index));
    if (!std::ranges::all_of(numbers, [](float x) { return std::isfinite(x); }))
      access.fail(fmt::format("a place of its node {} is not finite", index));
    count = numbers.size() / width;
    if (*count > kMostPlaces)
      access.fail(fmt::format("its node {} is in more than {} places", index, kMostPlaces));
    children.resize(*count, child);
    for (std::size_t k = 0; k < *count; ++k) {
      const auto first = numbers.begin() + static_cast<std::ptrdiff_t>(k * width);
      children[k][key] = std::vector<float>(first, first + static_cast<std::ptrdiff_t>(width));
    }
  }
  if (!count) access.fail(fmt::format("its node {} states no places", index));
  return children;
}

}  // namespace

void expand_gltf_instances(const GltfAccess& access, json& document) {
  if (!document.contains("nodes") || !document["nodes"].is_array()) return;
  json& nodes = document["nodes"];
  const std::size_t stated = nodes.size();
  for (std::size_t i = 0; i < stated; ++i) {
    std::optional<std::vector<json>> children = children_of(nodes[i], i, access);
    if (!children) continue;
    if (nodes.size() - stated + children->size() > kMostPlaces)
      access.fail(fmt::format("its nodes are in more than {} places", kMostPlaces));
    nodes[i].erase("mesh");
    nodes[i]["extensions"].erase(kExtension);
    for (json& child : *children) {
      nodes[i]["children"].push_back(nodes.size());
      nodes.push_back(std::move(child));
    }
  }
}

}  // namespace saccade
