#include "simulator/scene/build_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/process/progress.h"
#include "simulator/motion/motion.h"
#include "simulator/scene/light/area_light.h"
#include "simulator/scene/mesh/mesh_import.h"
#include "simulator/scene/mesh_placement.h"
#include "simulator/scene/scene_builder.h"
#include "simulator/scene/texture/picture.h"
#include "simulator/scene/world/world.h"

namespace saccade {
namespace {

/// glTF defines +y as up, other formats leave it open. Who turns a mesh by hand knows that.
void remark_up_axis(const MeshOptions& options, SceneRemarks& remarks) {
  std::string ending = options.file.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if ((ending == ".gltf" || ending == ".glb") && !options.is_up_stated &&
      options.transform.rotation_deg.isZero())
    remarks.say(fmt::format(
        "{}: glTF files are y-up, and this one is taken as z-up: state up: y to stand it upright, "
        "or up: z",
        options.file.string()));
}

/// A file, and which of its animations it is read with.
using MeshKey = std::pair<std::filesystem::path, std::optional<std::string>>;
using MeshUses = std::map<MeshKey, std::size_t>;

MeshKey key_of(const MeshOptions& item) {
  return {item.file, item.animation ? std::optional(item.animation->name) : std::nullopt};
}

/// Those that are still, in the order of their first use; `uses` gets how often each is used.
std::vector<std::filesystem::path> still_files(const std::vector<MeshOptions>& meshes,
                                               MeshUses& uses) {
  std::vector<std::filesystem::path> files;
  for (const MeshOptions& item : meshes)
    if (++uses[key_of(item)] == 1 && !item.animation) files.push_back(item.file);
  return files;
}

MeshSurface surface_of(const MeshOptions& options) {
  std::optional<Gloss> gloss;
  if (options.gloss) gloss = make_gloss(options.gloss->reflectance, options.gloss->roughness);
  return {options.texture, options.texture_seed, options.reflectance, gloss};
}

InstanceLabel label_of(const MeshOptions& options, const std::vector<std::string>& classes) {
  const auto found = std::find(classes.begin(), classes.end(), options.class_name);
  const auto class_id = found == classes.end() ? 0 : found - classes.begin() + 1;
  return {options.file.stem().string(), options.file.generic_string(),
          static_cast<std::uint8_t>(class_id), options.instances == Instances::kNodes};
}

ImageF read_surroundings(const std::filesystem::path& picture, ColourChannel channel,
                         SceneRemarks& remarks) {
  const FileLocation location = FileLocation::parse(picture);
  const std::optional<Bytes> bytes = FileSource(location.archive).read(location.file);
  if (!bytes) throw InputError(location.text(), "this background picture does not exist");
  return decode_picture(*bytes, location.text(), remarks, {1, 1, 1}, channel).grey;
}

Background read_background(const SceneOptions& options, ColourChannel channel,
                           SceneRemarks& remarks) {
  if (options.background_picture.empty()) return Background(options.background);
  return Background(read_surroundings(options.background_picture, channel, remarks),
                    options.background_yaw_deg);
}

EnvironmentLight read_environment(const SceneOptions& options, ColourChannel channel,
                                  SceneRemarks& remarks) {
  const EnvironmentLightOptions& light = *options.environment_light;
  const std::filesystem::path& picture =
      light.picture ? *light.picture : options.background_picture;
  if (picture.empty()) return EnvironmentLight(light.scale * options.background);
  return {read_surroundings(picture, channel, remarks), options.background_yaw_deg, light.scale};
}

/// Appends the lights of a file, moved to where its mesh stands.
void add_lights(const Mesh& mesh, const Eigen::Affine3d& world_from_mesh, double scale,
                std::vector<LightOptions>& lights) {
  for (LightOptions light : mesh.lights) {
    light.position = world_from_mesh * light.position;
    light.direction = (world_from_mesh.linear() * light.direction).normalized();
    light.intensity *= scale;
    lights.push_back(light);
  }
  if (const std::size_t count = emitter_count(lights); count > kMaxLights)
    throw InputError("scene.lights",
                     fmt::format("are {} with those of the mesh files, which must be at most {}",
                                 count, kMaxLights));
}

/// The generated objects of a world, after the meshes of files.
void add_world_parts(const World& world, SceneBuilder& builder) {
  for (const WorldPart& part : world.parts) {
    const Eigen::Affine3d transform(part.world_from_mesh);
    const InstanceLabel label{part.name, "", 0, false};
    if (part.trajectory)
      builder.add_moving(part.mesh, transform,
                         build_motion(*part.trajectory, "scene.world.trajectory"), label);
    else
      builder.add(part.mesh, transform, label);
  }
}

}  // namespace

Scene build_scene(const SceneOptions& options, ColourChannel channel) {
  SceneBuilder builder;
  MeshImporter importer({options.missing_texture, options.lighting == Lighting::kLambertian,
                         channel, takes_lights(options), options.normal_maps, options.gloss});
  World world;
  if (options.world) world = make_world(*options.world, importer.remarks(), channel);
  std::vector<MeshOptions> items = options.meshes;
  items.insert(items.end(), world.files.begin(), world.files.end());
  MeshUses uses;
  importer.prefetch(still_files(items, uses));
  std::map<MeshKey, Mesh> meshes;
  const std::vector<std::string> classes = class_names(options);
  std::vector<LightOptions> lights = options.lights;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const MeshOptions& item = items[i];
    const MeshKey key = key_of(item);
    auto known = meshes.find(key);
    if (known == meshes.end())
      known = meshes.emplace(key, importer.read(key.first, key.second)).first;
    std::optional<Mesh> changed;
    if (const MeshSurface surface = surface_of(item); surface.is_changed())
      changed = importer.with_surface(known->second, surface, item.file.string());
    const Mesh& mesh = changed ? *changed : known->second;
    remark_up_axis(item, importer.remarks());
    const Eigen::Affine3d transform = world_from_mesh(item, mesh);
    std::optional<Spline> motion;
    if (item.trajectory)
      motion = build_motion(*item.trajectory, fmt::format("scene.meshes[{}].trajectory", i));
    const InstanceLabel label = label_of(item, classes);
    const std::size_t kept =
        item.animation ? builder.add_animated(mesh, transform, *item.animation, motion, label)
        : motion       ? builder.add_moving(mesh, transform, *motion, label)
                       : builder.add(mesh, transform, label);
    if (kept == 0) throw InputError(item.file.string(), "none of its triangles has an area");
    if (!item.trajectory)
      add_lights(mesh, transform, options.light_scale, lights);
    else if (!mesh.lights.empty())
      importer.remarks().say(fmt::format(
          "{}: its lights do not light the scene, because scene.meshes[{}] has a trajectory",
          item.file.string(), i));
    if (--uses[key] == 0) meshes.erase(known);
  }
  add_world_parts(world, builder);
  if (items.empty() && world.parts.empty()) throw InputError("scene.meshes", "names no mesh");
  if (options.lighting == Lighting::kLambertian) {
    builder.light(options.ambient, lights, options.ambient_flicker);
    if (options.environment_light)
      builder.light_from_around(read_environment(options, channel, importer.remarks()));
  }
  const Background background = read_background(options, channel, importer.remarks());
  if (channel == ColourChannel::kLuminance)
    for (const std::string& line : importer.remarks().lines()) show_warning(line);
  return std::move(builder).build(background);
}

}  // namespace saccade
