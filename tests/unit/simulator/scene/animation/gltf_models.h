#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "simulator/scene/mesh/base64.h"

namespace saccade::testing {

/// A glTF file in the making, its buffer inside.
class GltfModel {
 public:
  using json = nlohmann::json;

  json document = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}};

  /// Index of a new accessor over `values`, `width` of them per element.
  template <class T>
  std::size_t add(const std::vector<T>& values, const char* type, std::size_t width,
                  int component) {
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    const std::size_t size = values.size() * sizeof(T);
    document["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", size}});
    const std::size_t from = bytes_.size();
    bytes_.resize(from + size);
    std::memcpy(bytes_.data() + from, values.data(), size);
    json accessor = {{"bufferView", document["bufferViews"].size() - 1},
                     {"componentType", component},
                     {"count", values.size() / width},
                     {"type", type}};
    document["accessors"].push_back(std::move(accessor));
    return document["accessors"].size() - 1;
  }
  std::size_t floats(const std::vector<float>& values, const char* type, std::size_t width) {
    return add(values, type, width, 5126);
  }
  std::size_t indices(const std::vector<std::uint16_t>& values) {
    return add(values, "SCALAR", 1, 5123);
  }

  /// A channel of animation 0.
  void animate(std::size_t node, const char* path, const std::vector<float>& times_s,
               const std::vector<float>& values, const char* interpolation = "LINEAR") {
    const bool is_rotation = std::string(path) == "rotation";
    const std::size_t input = floats(times_s, "SCALAR", 1);
    const std::size_t output = floats(values, is_rotation ? "VEC4" : "VEC3", is_rotation ? 4U : 3U);
    json& animation = document["animations"][0];
    if (!animation.contains("name")) animation["name"] = "move";
    animation["samplers"].push_back(
        {{"input", input}, {"output", output}, {"interpolation", interpolation}});
    animation["channels"].push_back({{"sampler", animation["samplers"].size() - 1},
                                     {"target", {{"node", node}, {"path", path}}}});
  }

  [[nodiscard]] std::string text() const {
    json complete = document;
    complete["buffers"] = {{{"byteLength", bytes_.size()},
                            {"uri", "data:application/octet-stream;base64," + base64_of(bytes_)}}};
    return complete.dump();
  }

 private:
  std::vector<unsigned char> bytes_;
};

/// Keys of a rotation about z at a constant rate, a quarter turn from one to the next.
inline void turn_about_z(GltfModel& model, std::size_t node, double rate_rad_s, int quarters) {
  std::vector<float> times, rotations;
  for (int k = 0; k <= quarters; ++k) {
    const double angle = k * std::numbers::pi / 2;
    times.push_back(static_cast<float>(angle / rate_rad_s));
    for (const double value : {0.0, 0.0, std::sin(angle / 2), std::cos(angle / 2)})
      rotations.push_back(static_cast<float>(value));
  }
  model.animate(node, "rotation", times, rotations);
}

/// A strip in the plane z = 0, x in [0, 2], y in [-0.25, 0.25], of nine columns of vertices, on two
/// bones: what is left of x = 0.75 rests, what is right of 1.25 turns about z and the point (1, 0,
/// 0) with pi rad/s for a second, and the column at x = 1 is moved by both alike. The albedo is
/// (x + 1) / 4 at rest. Node 0 holds the mesh, which is turned: a skin does not care.
inline GltfModel strip_on_bones() {
  GltfModel model;
  std::vector<float> positions, normals, colours, weights;
  std::vector<std::uint8_t> joints;
  std::vector<std::uint16_t> corners;
  for (std::uint16_t k = 0; k < 9; ++k)
    for (const float y : {-0.25F, 0.25F}) {
      const float x = 0.25F * static_cast<float>(k);
      positions.insert(positions.end(), {x, y, 0});
      normals.insert(normals.end(), {0, 0, 1});
      const float albedo = (x + 1) / 4;
      colours.insert(colours.end(), {albedo, albedo, albedo});
      const float second = k < 4 ? 0.0F : k > 4 ? 1.0F : 0.5F;
      weights.insert(weights.end(), {1 - second, second, 0, 0});
      joints.insert(joints.end(), {0, 1, 0, 0});
    }
  for (std::uint16_t k = 0; k < 8; ++k)
    for (const int corner : {0, 2, 1, 1, 2, 3})
      corners.push_back(static_cast<std::uint16_t>(2 * k + corner));
  const std::size_t inverse_binds = model.floats(
      {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,  // the second bone is bound at (1, 0, 0)
       1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1},
      "MAT4", 16);
  model.document["scenes"][0]["nodes"] = {0, 1};
  model.document["nodes"] = {
      {{"name", "body"}, {"mesh", 0}, {"skin", 0}, {"rotation", {0, 1, 0, 0}}},
      {{"name", "hip"}, {"children", {2}}},
      {{"name", "knee"}, {"translation", {1, 0, 0}}}};
  model.document["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", inverse_binds}}};
  model.document["materials"] = {{{"pbrMetallicRoughness", {{"metallicFactor", 0}}}}};
  const auto position = model.floats(positions, "VEC3", 3);
  model.document["accessors"][position]["min"] = {0, -0.25, 0};
  model.document["accessors"][position]["max"] = {2, 0.25, 0};
  const GltfModel::json attributes = {{"POSITION", position},
                                      {"NORMAL", model.floats(normals, "VEC3", 3)},
                                      {"COLOR_0", model.floats(colours, "VEC3", 3)},
                                      {"WEIGHTS_0", model.floats(weights, "VEC4", 4)},
                                      {"JOINTS_0", model.add(joints, "VEC4", 4, 5121)}};
  model.document["meshes"] = {
      {{"primitives",
        {{{"attributes", attributes}, {"indices", model.indices(corners)}, {"material", 0}}}}}};
  turn_about_z(model, 2, std::numbers::pi, 2);
  return model;
}

/// A square [0, 1]^2 at z = 0 whose albedo rises from 0.2 to 0.6 with x, on node 0, without keys.
inline GltfModel square_on_node() {
  GltfModel model;
  const auto position = model.floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3", 3);
  model.document["accessors"][position]["min"] = {0, 0, 0};
  model.document["accessors"][position]["max"] = {1, 1, 0};
  const auto colour = model.floats(
      {0.2F, 0.2F, 0.2F, 0.6F, 0.6F, 0.6F, 0.6F, 0.6F, 0.6F, 0.2F, 0.2F, 0.2F}, "VEC3", 3);
  const auto corners = model.indices({0, 1, 2, 0, 2, 3});
  model.document["nodes"] = {{{"name", "square"}, {"mesh", 0}}};
  model.document["materials"] = {{{"pbrMetallicRoughness", {{"metallicFactor", 0}}}}};
  model.document["meshes"] = {{{"primitives",
                                {{{"attributes", {{"POSITION", position}, {"COLOR_0", colour}}},
                                  {"indices", corners},
                                  {"material", 0}}}}}};
  return model;
}

}  // namespace saccade::testing
