#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace saccade::testing {

/// A map of Quake III, written table by table.
class Quake3MapFile {
 public:
  struct Vertex {
    std::array<float, 3> position;
    std::array<float, 2> uv;
    std::array<float, 3> normal;
  };

  std::string entities = "{ \"classname\" \"worldspawn\" }\n";
  std::int32_t version = 46;

  std::int32_t add_shader(const std::string& name, std::uint32_t flags = 0) {
    std::string row = name;
    row.resize(64, '\0');
    put(flags, row);
    put(0, row);
    shaders_ += row;
    return static_cast<std::int32_t>(shaders_.size() / 72 - 1);
  }

  /// `kind`: 1 polygon, 2 curved, 3 mesh, 4 flare. `corners` are counted from the face's first vertex.
  void add_face(std::int32_t kind, std::int32_t shader, const std::vector<Vertex>& vertices,
                const std::vector<std::int32_t>& corners,
                std::array<std::int32_t, 2> patch_size = {0, 0}) {
    std::string row;
    for (const std::int32_t value :
         {shader, -1, kind, static_cast<std::int32_t>(vertices_.size() / 44),
          static_cast<std::int32_t>(vertices.size()),
          static_cast<std::int32_t>(corners_.size() / 4),
          static_cast<std::int32_t>(corners.size())})
      put(value, row);
    row.resize(96, '\0');
    put(patch_size[0], row);
    put(patch_size[1], row);
    faces_ += row;
    for (const Vertex& vertex : vertices) add_vertex(vertex);
    for (const std::int32_t corner : corners) put(corner, corners_);
  }

  /// A square of 32 units at height z, its texture once over it.
  void add_square(std::int32_t shader, float z = 0) {
    add_face(1, shader,
             {{{0, 0, z}, {0, 0}, {0, 0, 1}},
              {{32, 0, z}, {1, 0}, {0, 0, 1}},
              {{32, 32, z}, {1, 1}, {0, 0, 1}},
              {{0, 32, z}, {0, 1}, {0, 0, 1}}},
             {0, 2, 1, 0, 3, 2});
  }

  /// All faces that no model has yet; the first model is the world.
  void end_model() {
    std::string row(24, '\0');
    const auto count = static_cast<std::int32_t>(faces_.size() / 104);
    for (const std::int32_t value : {first_face_, count - first_face_, 0, 0}) put(value, row);
    first_face_ = count;
    models_ += row;
  }

  [[nodiscard]] std::string bytes() const {
    std::string head = "IBSP", tables;
    put(version, head);
    for (int lump = 0; lump < 17; ++lump) {
      const std::string& table = lump == 0    ? entities
                                 : lump == 1  ? shaders_
                                 : lump == 7  ? models_
                                 : lump == 10 ? vertices_
                                 : lump == 11 ? corners_
                                 : lump == 13 ? faces_
                                              : none_;
      put(static_cast<std::int32_t>(144 + tables.size()), head);
      put(static_cast<std::int32_t>(table.size()), head);
      tables += table;
    }
    return head + tables;
  }

 private:
  template <class T>
  static void put(T value, std::string& row) {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), &value, sizeof value);
    row.append(bytes.data(), bytes.size());
  }

  void add_vertex(const Vertex& vertex) {
    for (const float x : vertex.position) put(x, vertices_);
    for (const float x : vertex.uv) put(x, vertices_);
    vertices_.append(8, '\0');
    for (const float x : vertex.normal) put(x, vertices_);
    vertices_.append(4, '\0');
  }

  std::string shaders_, models_, vertices_, corners_, faces_, none_;
  std::int32_t first_face_ = 0;
};

}  // namespace saccade::testing
