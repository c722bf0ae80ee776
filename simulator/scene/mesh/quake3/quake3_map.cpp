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
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "core/io/files/byte_reader.h"
#include "simulator/scene/mesh/quake3/bezier_patch.h"
#include "simulator/scene/mesh/quake3/quake3_entities.h"

namespace saccade {
namespace {

/// The tables of a map that are read, by their place in its header.
enum class Lump : std::size_t {
  kEntities = 0,
  kShaders = 1,
  kModels = 7,
  kVertices = 10,
  kTriangleCorners = 11,
  kFaces = 13
};
constexpr std::size_t kLumps = 17;
constexpr std::size_t kHeaderSize = 8 + 8 * kLumps;

// As they lie in the file.
struct FileShader {
  std::array<char, 64> name;
  std::uint32_t surface_flags;
  std::uint32_t content_flags;
};
struct FileModel {
  std::array<float, 6> box;
  std::int32_t first_face, face_count;
  std::int32_t first_brush, brush_count;
};
struct FileVertex {
  std::array<float, 3> position;
  std::array<float, 2> uv;
  std::array<float, 2> light_uv;
  std::array<float, 3> normal;
  std::array<std::uint8_t, 4> colour;
};
struct FileFace {
  std::int32_t shader, fog, kind;
  std::int32_t first_vertex, vertex_count;
  std::int32_t first_corner, corner_count;
  std::array<std::int32_t, 5> light_map;
  std::array<float, 9> light_axes;
  std::array<float, 3> normal;
  std::array<std::int32_t, 2> patch_size;
};
static_assert(sizeof(FileShader) == 72 && sizeof(FileModel) == 40 && sizeof(FileVertex) == 44 &&
              sizeof(FileFace) == 104);

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

[[noreturn]] void damaged(const std::string& what) {
  throw std::runtime_error("is a damaged map: " + what);
}

/// The tables of the file.
class MapTables {
 public:
  explicit MapTables(const Bytes& bytes) : bytes_(std::as_bytes(std::span(bytes))) {
    if (bytes_.size() < kHeaderSize || std::memcmp(bytes_.data(), "IBSP", 4) != 0)
      throw std::runtime_error("is no map of Quake III Arena: it does not begin with IBSP");
    const auto version = load<std::int32_t>(bytes_.data() + 4);
    if (version != 46 && version != 47)
      throw std::runtime_error(fmt::format(
          "is a map of version {}; those of Quake III Arena (46, 47) are read", version));
  }

  template <class Row>
  [[nodiscard]] std::vector<Row> rows(Lump lump) const {
    const std::span<const std::byte> part = bytes_of(lump);
    std::vector<Row> result(part.size() / sizeof(Row));
    if (!result.empty()) std::memcpy(result.data(), part.data(), result.size() * sizeof(Row));
    return result;
  }

  [[nodiscard]] std::string_view text(Lump lump) const {
    const std::span<const std::byte> part = bytes_of(lump);
    const std::string_view all(reinterpret_cast<const char*>(part.data()), part.size());
    return all.substr(0, all.find('\0'));
  }

 private:
  [[nodiscard]] std::span<const std::byte> bytes_of(Lump lump) const {
    const std::byte* entry = bytes_.data() + 8 + 8 * static_cast<std::size_t>(lump);
    const auto offset = load<std::uint32_t>(entry), size = load<std::uint32_t>(entry + 4);
    if (offset > bytes_.size() || size > bytes_.size() - offset)
      damaged(fmt::format("its table {} ends behind the file", static_cast<std::size_t>(lump)));
    return bytes_.subspan(offset, size);
  }

  std::span<const std::byte> bytes_;
};

/// `count` items from `first` on; an error where there are fewer.
template <class Item>
std::span<const Item> range_of(const std::vector<Item>& all, std::int32_t first, std::int32_t count,
                               const char* what) {
  if (first < 0 || count < 0 ||
      static_cast<std::size_t>(first) + static_cast<std::size_t>(count) > all.size())
    damaged(fmt::format("it has no {} {} to {}", what, first, std::int64_t{first} + count - 1));
  return std::span(all).subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(count));
}

Quake3Vertex vertex_of(const FileVertex& vertex) {
  const auto& [x, y, z] = vertex.position;
  return {{x * kMetresPerUnit, y * kMetresPerUnit, z * kMetresPerUnit}, vertex.uv, vertex.normal};
}

class MapReader {
 public:
  explicit MapReader(const MapTables& tables)
      : entities_(parse_quake3_entities(tables.text(Lump::kEntities))),
        shaders_(tables.rows<FileShader>(Lump::kShaders)),
        models_(tables.rows<FileModel>(Lump::kModels)),
        vertices_(tables.rows<FileVertex>(Lump::kVertices)),
        corners_(tables.rows<std::int32_t>(Lump::kTriangleCorners)),
        faces_(tables.rows<FileFace>(Lump::kFaces)) {}

  [[nodiscard]] Model read() {
    for (const FileShader& shader : shaders_) {
      ModelMaterial& material = result_.materials.emplace_back();
      material.name =
          printable({shader.name.data(), strnlen(shader.name.data(), shader.name.size())});
      material.ignored.emplace_back("baked light");
    }
    if (models_.empty()) damaged("it has no world");
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
    if (index == 0 || index >= models_.size())
      damaged(fmt::format("its entity '{}' is of model {}, which it has not", kind, model));
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
    const FileModel& model = models_[index];
    std::map<std::int32_t, ModelPart> parts;  // by shader
    for (const FileFace& face : range_of(faces_, model.first_face, model.face_count, "faces")) {
      if (face.shader < 0 || static_cast<std::size_t>(face.shader) >= shaders_.size())
        damaged(fmt::format("a face is of shader {}, which it has not", face.shader));
      const std::uint32_t flags = shaders_[static_cast<std::size_t>(face.shader)].surface_flags;
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

  void add_face(const FileFace& face, ModelPart& part) {
    if (face.kind != kPolygon && face.kind != kMesh && face.kind != kPatch) return;  // flares
    const auto vertices = range_of(vertices_, face.first_vertex, face.vertex_count, "vertices");
    if (face.kind == kPatch)
      add_patch(face, vertices, part);
    else
      add_triangles(face, vertices, part);
  }

  void add_triangles(const FileFace& face, std::span<const FileVertex> vertices, ModelPart& part) {
    const auto corners = range_of(corners_, face.first_corner, face.corner_count, "corners");
    // Corners count as well: many triangles may share few vertices.
    const std::uint32_t first = first_of(vertices.size() + corners.size(), part);
    for (const FileVertex& vertex : vertices) add_vertex(vertex_of(vertex), part);
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
      for (std::size_t k = i; k < i + 3; ++k)
        if (corners[k] < 0 || static_cast<std::size_t>(corners[k]) >= vertices.size())
          damaged(fmt::format("a face has no corner {}", corners[k]));
      add_triangle({first + static_cast<std::uint32_t>(corners[i]),
                    first + static_cast<std::uint32_t>(corners[i + 1]),
                    first + static_cast<std::uint32_t>(corners[i + 2])},
                   part);
    }
  }

  void add_patch(const FileFace& face, std::span<const FileVertex> vertices, ModelPart& part) {
    const auto [width, height] = face.patch_size;
    if (width < 3 || height < 3 || width % 2 == 0 || height % 2 == 0 ||
        std::int64_t{width} * height != static_cast<std::int64_t>(vertices.size()))
      damaged(fmt::format("a curved face has {} x {} control points", width, height));
    std::vector<Quake3Vertex> control;
    control.reserve(vertices.size());
    for (const FileVertex& vertex : vertices) control.push_back(vertex_of(vertex));
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

  std::vector<Quake3Entity> entities_;
  std::vector<FileShader> shaders_;
  std::vector<FileModel> models_;
  std::vector<FileVertex> vertices_;
  std::vector<std::int32_t> corners_;
  std::vector<FileFace> faces_;
  std::size_t vertices_added_ = 0;
  Model result_;
};

}  // namespace

bool is_quake3_map(const std::filesystem::path& file) { return lower_ending_of(file) == ".bsp"; }

bool is_quake3_archive(const std::filesystem::path& file) {
  return lower_ending_of(file) == ".pk3";
}

Model read_quake3_map(const Bytes& bytes) { return MapReader(MapTables(bytes)).read(); }

}  // namespace saccade
