#include "simulator/scene/mesh/quake3/quake3_map.h"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <map>
#include <numbers>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "simulator/scene/mesh/quake3/bezier_patch.h"
#include "simulator/scene/mesh/quake3/quake3_entities.h"
#include "simulator/scene/mesh/quake3/quake3_tables.h"

namespace saccade {
namespace {

constexpr std::int32_t kPolygon = 1, kPatch = 2, kMesh = 3;
constexpr std::uint32_t kIsSky = 0x4, kIsHint = 0x100, kIsSkipped = 0x200, kIsNotDrawn = 0x80;
constexpr float kMetresPerUnit = 1.0F / 32;
/// The game takes 524288 vertices. Were all of them control points of patches, 16 times as many
/// would be shown; a damaged file can name the same ones again and again.
constexpr std::size_t kMostVertices = std::size_t{16} * 524288;

std::string lower_ending_of(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

/// Names of a file are any bytes; those of labels and of errors are text.
std::string printable(std::string name) {
  for (char& c : name)
    if (c < ' ' || c > '~') c = '?';
  return name;
}

Quake3Vertex vertex_of(const Quake3VertexRow& vertex) {
  const auto& [x, y, z] = vertex.position;
  return {{x * kMetresPerUnit, y * kMetresPerUnit, z * kMetresPerUnit}, vertex.uv, vertex.normal};
}

class MapReader {
 public:
  explicit MapReader(const Quake3Tables& tables)
      : tables_(tables), entities_(parse_quake3_entities(tables.entities)) {}

  [[nodiscard]] Model read() {
    for (const Quake3ShaderRow& shader : tables_.shaders) {
      ModelMaterial& material = result_.materials.emplace_back();
      material.name =
          printable({shader.name.data(), strnlen(shader.name.data(), shader.name.size())});
      material.ignored.emplace_back("baked light");
    }
    if (tables_.models.empty()) fail_as_damaged_map("it has no world");
    add_model(0, "worldspawn", Eigen::Vector3d::Zero());
    for (const Quake3Entity& entity : entities_) add_entity(entity);
    return std::move(result_);
  }

 private:
  void add_entity(const Quake3Entity& entity) {
    const std::string kind = printable(entity.value("classname"));
    const std::string model = printable(entity.value("model"));
    if (kind == "light") ++result_.lights;
    if (kind.starts_with("info_player_") || kind == "team_CTF_redspawn" ||
        kind == "team_CTF_bluespawn")
      add_camera(entity, kind);
    if (model.size() < 2 || model.front() != '*') return;
    const std::size_t index = std::strtoul(model.c_str() + 1, nullptr, 10);
    // The world itself is no entity's.
    if (index == 0 || index >= tables_.models.size())
      fail_as_damaged_map(
          fmt::format("its entity '{}' is of model {}, which it has not", kind, model));
    add_model(index, fmt::format("{} {}", kind, model),
              entity.vector("origin") * double{kMetresPerUnit});
  }

  /// Angles are those of the game: turned to the left, and the camera's nose down, in degrees.
  void add_camera(const Quake3Entity& entity, const std::string& kind) {
    constexpr double kEyes = 26;  // above a player's origin [units]
    Eigen::Vector3d angles = entity.vector("angles");
    if (entity.values.contains("angle"))
      angles = {0, std::strtod(entity.value("angle").c_str(), nullptr), 0};
    const Eigen::Vector3d rad = angles * (std::numbers::pi / 180);
    if (!rad.allFinite()) return;
    const Eigen::Vector3d at =
        (entity.vector("origin") + kEyes * Eigen::Vector3d::UnitZ()) * double{kMetresPerUnit};
    ModelCamera& camera = result_.cameras.emplace_back();
    camera.name = fmt::format("{} {}", kind, result_.cameras.size());
    camera.position = {at.x(), at.y(), at.z()};
    camera.forward = {std::cos(rad.x()) * std::cos(rad.y()), std::cos(rad.x()) * std::sin(rad.y()),
                      -std::sin(rad.x())};
    camera.up = {std::sin(rad.x()) * std::cos(rad.y()), std::sin(rad.x()) * std::sin(rad.y()),
                 std::cos(rad.x())};
  }

  void add_model(std::size_t index, const std::string& name, const Eigen::Vector3d& origin) {
    const Quake3ModelRow& model = tables_.models[index];
    std::map<std::int32_t, ModelPart> parts;  // by shader
    for (const Quake3FaceRow& face :
         rows_of(tables_.faces, model.first_face, model.face_count, "faces")) {
      if (face.shader < 0 || static_cast<std::size_t>(face.shader) >= tables_.shaders.size())
        fail_as_damaged_map(fmt::format("a face is of shader {}, which it has not", face.shader));
      const std::uint32_t flags =
          tables_.shaders[static_cast<std::size_t>(face.shader)].surface_flags;
      if ((flags & (kIsSky | kIsHint | kIsSkipped | kIsNotDrawn)) != 0) continue;
      add_face(face, parts[face.shader]);
    }
    const auto node = static_cast<std::uint32_t>(result_.tree.size());
    ModelNode& tree_node = result_.tree.emplace_back();
    tree_node.name = name;
    for (int i = 0; i < 3; ++i)
      tree_node.parent_from_node[12U + static_cast<std::size_t>(i)] = origin[i];
    result_.nodes.push_back(name);
    for (auto& [shader, part] : parts) {
      if (part.triangles.empty()) continue;
      part.material = static_cast<std::uint32_t>(shader);
      result_.instances.push_back({static_cast<std::uint32_t>(result_.parts.size()),
                                   static_cast<std::uint32_t>(result_.nodes.size() - 1), node,
                                   result_.tree.back().parent_from_node});
      result_.parts.push_back(std::move(part));
    }
  }

  void add_face(const Quake3FaceRow& face, ModelPart& part) {
    if (face.kind != kPolygon && face.kind != kMesh && face.kind != kPatch) return;  // flares
    const auto vertices =
        rows_of(tables_.vertices, face.first_vertex, face.vertex_count, "vertices");
    if (face.kind == kPatch)
      add_patch(face, vertices, part);
    else
      add_triangles(face, vertices, part);
  }

  void add_triangles(const Quake3FaceRow& face, std::span<const Quake3VertexRow> vertices,
                     ModelPart& part) {
    const auto corners = rows_of(tables_.corners, face.first_corner, face.corner_count, "corners");
    // Corners count as well: many triangles may share few vertices.
    const std::uint32_t first = first_of(vertices.size() + corners.size(), part);
    for (const Quake3VertexRow& vertex : vertices) add_vertex(vertex_of(vertex), part);
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
      for (std::size_t k = i; k < i + 3; ++k)
        if (corners[k] < 0 || static_cast<std::size_t>(corners[k]) >= vertices.size())
          fail_as_damaged_map(fmt::format("a face has no corner {}", corners[k]));
      add_triangle({first + static_cast<std::uint32_t>(corners[i]),
                    first + static_cast<std::uint32_t>(corners[i + 1]),
                    first + static_cast<std::uint32_t>(corners[i + 2])},
                   part);
    }
  }

  void add_patch(const Quake3FaceRow& face, std::span<const Quake3VertexRow> vertices,
                 ModelPart& part) {
    const auto [width, height] = face.patch_size;
    if (width < 3 || height < 3 || width % 2 == 0 || height % 2 == 0 ||
        std::int64_t{width} * height != static_cast<std::int64_t>(vertices.size()))
      fail_as_damaged_map(fmt::format("a curved face has {} x {} control points", width, height));
    std::vector<Quake3Vertex> control;
    control.reserve(vertices.size());
    for (const Quake3VertexRow& vertex : vertices) control.push_back(vertex_of(vertex));
    // Counted before they are made.
    const std::uint32_t first = first_of(
        divided_count(static_cast<std::size_t>(width), static_cast<std::size_t>(height)), part);
    const Quake3Grid grid = divide_patch(control, static_cast<std::size_t>(width));
    for (const Quake3Vertex& vertex : grid.vertices) add_vertex(vertex, part);
    const auto row = static_cast<std::uint32_t>(grid.width);
    for (std::uint32_t y = 0; y + 1 < grid.height; ++y)
      for (std::uint32_t x = 0; x + 1 < row; ++x) {
        const std::uint32_t corner = first + y * row + x;
        add_triangle({corner, corner + 1, corner + row}, part);
        add_triangle({corner + 1, corner + row + 1, corner + row}, part);
      }
  }

  /// The index of the next vertex of a part, to which `count` vertices and corners are about to be
  /// added.
  std::uint32_t first_of(std::size_t count, const ModelPart& part) {
    vertices_added_ += count;
    if (vertices_added_ > kMostVertices)
      throw std::runtime_error(fmt::format("claims more than {} vertices", kMostVertices));
    return static_cast<std::uint32_t>(part.vertices.size());
  }

  static void add_vertex(const Quake3Vertex& vertex, ModelPart& part) {
    if (part.uvs.empty()) part.uvs.emplace_back();
    part.vertices.push_back(vertex.position);
    part.normals.push_back(vertex.normal);
    part.uvs.front().push_back({vertex.uv[0], 1 - vertex.uv[1]});
  }

  /// With the corners in the order that agrees with their normals; the game's turns the other way
  /// round. Curves that end in a point have triangles without an area, which are left out.
  static void add_triangle(std::array<std::uint32_t, 3> corners, ModelPart& part) {
    const auto position = [&](int i) { return Eigen::Vector3f(part.vertices[corners[i]].data()); };
    const auto normal = [&](int i) { return Eigen::Vector3f(part.normals[corners[i]].data()); };
    const Eigen::Vector3f face =
        (position(1) - position(0)).cross(position(2) - position(0)).eval();
    if (face.isZero(0)) return;
    if (face.dot(normal(0) + normal(1) + normal(2)) < 0) std::swap(corners[1], corners[2]);
    part.triangles.push_back(corners);
  }

  const Quake3Tables& tables_;
  std::vector<Quake3Entity> entities_;
  std::size_t vertices_added_ = 0;
  Model result_;
};

}  // namespace

bool is_quake3_map(const std::filesystem::path& file) { return lower_ending_of(file) == ".bsp"; }

bool is_quake3_archive(const std::filesystem::path& file) {
  return lower_ending_of(file) == ".pk3";
}

Model read_quake3_map(const Bytes& bytes) { return MapReader(read_quake3_tables(bytes)).read(); }

}  // namespace saccade
