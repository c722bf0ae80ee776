#include "simulator/scene/describe_mesh.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <numbers>
#include <set>
#include <vector>

#include <Eigen/Geometry>

#include "core/io/events/event_formats.h"
#include "simulator/scene/animation/model_motion.h"
#include "simulator/scene/animation/node_animation.h"
#include "simulator/scene/mesh/assimp_model.h"
#include "simulator/scene/mesh/mesh_import.h"
#include "simulator/scene/mesh/quake3/quake3_map.h"
#include "simulator/scene/world/world.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

std::string mesh_line(const std::string& label, const std::string& text) {
  return fmt::format("  {:<13}{}\n", label, text);
}

std::string lower_ending(const fs::path& path) {
  std::string ending = FileLocation::parse(path).file.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

Eigen::AlignedBox3d mesh_box(const Mesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) box.extend(vertex);
  return box;
}

/// Textures by their sizes, the largest first: "1024 x 1024 (3), 64 x 64".
std::string texture_sizes(const Mesh& mesh) {
  std::set<const Texture*> textures;
  for (const Material& material : mesh.materials)
    for (const Texture* texture : {material.texture.get(), material.opacity.get()})
      if (texture != nullptr) textures.insert(texture);
  std::map<std::pair<int, int>, int> counts;
  for (const Texture* texture : textures) ++counts[{-texture->width(), -texture->height()}];
  std::vector<std::string> sizes;
  sizes.reserve(counts.size());
  for (const auto& [size, count] : counts)
    sizes.push_back(fmt::format("{} x {}{}", -size.first, -size.second,
                                count > 1 ? fmt::format(" ({})", count) : ""));
  return sizes.empty() ? "none" : fmt::format("{}", fmt::join(sizes, ", "));
}

std::string vector_text(const Eigen::Vector3d& v) {
  return fmt::format("[{:.3g}, {:.3g}, {:.3g}]", v.x(), v.y(), v.z());
}

/// Which axis is up by the format's definition or habit.
bool is_y_up(const fs::path& path) {
  static const std::set<std::string> kYUp{".gltf", ".glb", ".fbx", ".dae", ".zae",
                                          ".ac",   ".acc", ".x3d", ".b3d", ".x"};
  return kYUp.contains(lower_ending(path));
}

bool is_gltf(const fs::path& path) {
  const std::string ending = lower_ending(path);
  return ending == ".gltf" || ending == ".glb";
}

/// As `up: y` turns it.
Eigen::Vector3d upright(const Eigen::Vector3d& v, bool is_turned) {
  return is_turned ? Eigen::Vector3d(v.x(), -v.z(), v.y()) : v;
}

/// As the trajectory's or a view's camera is stated.
std::string camera_line(const Model& model, const ModelCamera& camera, bool is_turned) {
  const NodeAnimation still(model.tree, nullptr);
  const auto nodes = still.file_from_nodes(0);
  const Eigen::Affine3d file_from_node =
      camera.node < 0 ? Eigen::Affine3d::Identity() : nodes[static_cast<std::size_t>(camera.node)];
  const Eigen::Vector3d at = file_from_node * Eigen::Vector3d(camera.position.data());
  const Eigen::Vector3d forward = file_from_node.linear() * Eigen::Vector3d(camera.forward.data());
  const Eigen::Vector3d position = upright(at, is_turned);
  const Eigen::Vector3d target = position + upright(forward, is_turned).normalized();
  return mesh_line(
      "camera",
      fmt::format(
          "'{}'{}; a trajectory of source model_camera, or a view in the entry below: "
          "{{t_s: 0, position: {}, look_at: {}}}",
          camera.name,
          camera.horizontal_fov_rad > 0
              ? fmt::format(" {:.0f} deg wide", camera.horizontal_fov_rad * 180 / std::numbers::pi)
              : "",
          vector_text(position), vector_text(target)));
}

/// Where an animation is stated: a camera that it moves is a trajectory.
std::string played_by(const Model& model, const ModelAnimation& animation, const fs::path& file) {
  const std::vector<bool> moved = NodeAnimation(model.tree, &animation).moved_nodes();
  for (const ModelCamera& camera : model.cameras)
    if (camera.node >= 0 && moved[static_cast<std::size_t>(camera.node)])
      return fmt::format(
          "; it moves the camera '{}': trajectory: {{source: model_camera, model: '{}', camera: "
          "'{}', animation: '{}', model_up: {}}}",
          camera.name, file.string(), camera.name, animation.name, is_y_up(file) ? "y" : "z");
  return fmt::format("; `animation: {{name: '{}'}}` in the entry below plays it", animation.name);
}

/// Animations and cameras.
std::string motion_lines(const fs::path& file, bool is_turned) {
  std::string text;
  const Model model = read_model_motion(file);
  for (std::size_t i = 0; i < model.animations.size(); ++i) {
    const ModelAnimation& animation = model.animations[i];
    const std::string problem = problem_of(animation);
    text += mesh_line("animation",
                      fmt::format("{} '{}' of {:.4g} s moves {} nodes{}", i, animation.name,
                                  animation.duration_s, animation.channels.size(),
                                  !problem.empty() ? "; cannot be played: it " + problem
                                                   : played_by(model, animation, file)));
  }
  for (const ModelCamera& camera : model.cameras) text += camera_line(model, camera, is_turned);
  return text;
}

/// A model of less than a millimetre or more than ten kilometres is in other units than metres.
constexpr double kSmallest_m = 1e-3, kLargest_m = 1e4;

/// Formats of surfaces alone, which are of either kind.
bool tells_no_up(const fs::path& path) {
  static const std::set<std::string> kEither{".obj", ".ply", ".stl", ".off"};
  return kEither.contains(lower_ending(path));
}

std::string suggestion(const fs::path& file, const Eigen::Vector3d& size, bool is_turned) {
  std::string text =
      fmt::format("  - {{file: '{}', up: {}}}\n", file.string(), is_turned ? "y" : "z");
  if (tells_no_up(file))
    text +=
        "  (the format does not say which axis is up: up: y where a preview lies on its side)\n";
  const double largest = size.maxCoeff();
  constexpr double kLargestRoom_m = 50;
  if (lower_ending(file) == ".fbx" && largest > kLargestRoom_m)
    text += fmt::format(
        "  (many programs write FBX in centimetres: state transform.scale: 0.01, or size_m, which "
        "is {} now)\n",
        vector_text(size));
  if (largest < kSmallest_m || largest > kLargest_m)
    text += fmt::format("  (its units are hardly metres: state size_m, which is {} now)\n",
                        vector_text(size));
  return "suggested entry of scene.meshes:\n" + text;
}

std::string problem_lines(const SceneRemarks& remarks) {
  std::string text;
  for (const std::string& line : remarks.lines()) text += mesh_line("note", line);
  return text;
}

std::string counts_of(const Mesh& mesh) {
  // Importers add materials that nothing has.
  std::set<std::uint32_t> used;
  for (const Triangle& triangle : mesh.triangles) used.insert(triangle.material);
  const auto textured = std::ranges::count_if(
      used, [&](std::uint32_t material) { return mesh.materials[material].texture != nullptr; });
  return fmt::format("{} triangles, {} materials ({} with textures)", mesh.triangles.size(),
                     used.size(), textured);
}

}  // namespace

bool is_mesh_name(const fs::path& path) {
  if (path.string().ends_with(".relief.yaml")) return true;
  const std::string ending = lower_ending(path);
  // What is not built in is a mesh all the same: the importer says so.
  static const std::set<std::string> kNotBuiltIn{
      ".wrl",  ".vrml", ".x3dv", ".blend", ".max", ".ma",   ".mb",  ".usd", ".usda",
      ".usdc", ".usdz", ".abc",  ".c4d",   ".skp", ".step", ".stp", ".iges"};
  if (kNotBuiltIn.contains(ending) || is_quake3_map("map" + ending)) return true;
  // Some endings are those of meshes and of events, as .raw of Prophesee's cameras: here events
  // are meant.
  return !ending.empty() && !is_event_file_name(path) && is_assimp_format(ending);
}

std::string describe_mesh(const fs::path& file) {
  MeshImporter importer({MissingTexture::kGrey, true});
  const Mesh mesh = importer.read(file);
  const Eigen::AlignedBox3d box = mesh_box(mesh);
  const bool is_turned = is_y_up(file);
  const MeshExtras& extras = mesh.extras;
  std::string text = fmt::format("{}: mesh file\n", file.string());
  text +=
      mesh_line("size", fmt::format("{} from {} to {} (axes of the file)", vector_text(box.sizes()),
                                    vector_text(box.min()), vector_text(box.max())));
  text += mesh_line("geometry", fmt::format("{}, {} parts in {} places", counts_of(mesh),
                                            extras.parts, extras.instances));
  text += mesh_line("textures", texture_sizes(mesh));
  if (extras.lights > 0)
    text += mesh_line(
        "lights", fmt::format("{} (not used: state {})", extras.lights,
                              is_gltf(file) ? "scene.lights_from_meshes: true" : "scene.lights"));
  if (lower_ending(file) != ".yaml") text += motion_lines(file, is_turned);
  return text + problem_lines(importer.remarks()) + suggestion(file, box.sizes(), is_turned);
}

std::string describe_scene(const SceneOptions& options) {
  MeshImporter importer({.missing_texture = MissingTexture::kGrey,
                         .is_lit = options.lighting == Lighting::kLambertian,
                         .takes_lights = takes_lights(options),
                         .takes_normal_maps = options.normal_maps,
                         .takes_gloss = options.gloss});
  std::string text;
  std::map<fs::path, int> uses;
  for (const MeshOptions& item : options.meshes) ++uses[item.file];
  std::size_t triangles = 0;
  for (const auto& [file, count] : uses) {
    const Mesh mesh = importer.read(file);
    triangles += mesh.triangles.size() * static_cast<std::size_t>(count);
    text += fmt::format("  {} x {}: {}; textures {}\n", count, file.string(), counts_of(mesh),
                        texture_sizes(mesh));
  }
  if (options.world) {
    const World world = make_world(*options.world, importer.remarks());
    std::size_t generated = 0;
    for (const WorldPart& part : world.parts) generated += part.mesh.triangles.size();
    text +=
        fmt::format("  {}: {} objects of {} triangles, and {} meshes of files\n",
                    world_title(*options.world), world.parts.size(), generated, world.files.size());
    triangles += generated;
  }
  return fmt::format("scene of {} meshes from {} files, {} triangles\n", options.meshes.size(),
                     uses.size(), triangles) +
         text + problem_lines(importer.remarks());
}

}  // namespace saccade
