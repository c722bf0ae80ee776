#include "simulator/scene/scene_options.h"

#include <algorithm>
#include <set>

#include "core/config/fields.h"
#include "core/config/suggest.h"
#include "simulator/scene/instance.h"
#include "simulator/scene/light/area_light.h"
#include "simulator/scene/mesh/file_source.h"
#include "simulator/scene/scene.h"

namespace saccade {
namespace {

void append_more_meshes(SceneOptions& options) {
  options.meshes.insert(options.meshes.end(), options.more_meshes.begin(),
                        options.more_meshes.end());
  options.more_meshes.clear();
}

void check_classes(config::Fields& fields, const SceneOptions& options) {
  const std::set<std::string> different(options.classes.begin(), options.classes.end());
  fields.expect(different.size() == options.classes.size(), "classes", "hold a name twice");
  fields.expect(!different.contains(""), "classes", "must not hold an empty name");
  for (const MeshOptions& mesh : options.meshes)
    fields.expect(
        options.classes.empty() || mesh.class_name.empty() || different.contains(mesh.class_name),
        "classes",
        "do not hold the class '" + mesh.class_name + "' of a mesh; " +
            config::suggestion(mesh.class_name, options.classes, "classes"));
  fields.expect(class_names(options).size() <= kMaxClasses, "meshes", "name more than 255 classes");
}

/// The keys of a scene that lights light.
void describe_lights(config::Fields& fields, SceneOptions& options) {
  fields
      .value("ambient", options.ambient, "Radiance of a white surface in the ambient light alone.")
      .at_least(0);
  fields.section("ambient_flicker", options.ambient_flicker,
                 "Flicker of the ambient light: in a room, that of the lamps whose light the walls "
                 "scatter.");
  fields.section(
      "environment_light", options.environment_light,
      "Light of the surroundings on all surfaces, by their normals and without shadows, "
      "in spherical harmonics up to second order. By default there is none: the background is "
      "only seen.");
  fields.list("lights", options.lights,
              "Point lights, spots, directional lights and area lights, at most 64, each emitter "
              "of an area light counted.");
  fields.expect(emitter_count(options.lights) <= kMaxLights, "lights",
                "must be at most 64, with every emitter of area lights counted");
  fields.value("normal_maps", options.normal_maps,
               "Whether the normal maps of mesh files bend the normals that light falls on. "
               "Normals of labels stay those of the triangles.");
  fields.value(
      "gloss", options.gloss,
      "Whether surfaces of glTF files mirror the lights, by their factors of roughness and "
      "metalness: one highlight per light, that moves with the camera. Surroundings are "
      "not mirrored.");
  fields.value("lights_from_meshes", options.lights_from_meshes,
               "Whether the lights of glTF files (KHR_lights_punctual) light the scene as well, "
               "where their meshes stand. Those of meshes with a trajectory do not.");
  if (options.lights_from_meshes)
    fields
        .value("light_scale", options.light_scale,
               "Intensity of a light of a glTF file per candela, of a directional one per lux. By "
               "default 1 / pi: then radiance is luminance in cd/m^2, as a white surface under E "
               "lux has E / pi of it, and as the files state emission.")
        .above(0);
}

}  // namespace

std::vector<std::string> class_names(const SceneOptions& options) {
  if (!options.classes.empty()) return options.classes;
  std::vector<std::string> names;
  for (const MeshOptions& mesh : options.meshes)
    if (!mesh.class_name.empty() && std::ranges::find(names, mesh.class_name) == names.end())
      names.push_back(mesh.class_name);
  return names;
}

std::size_t emitter_count(const std::vector<LightOptions>& lights) {
  std::size_t count = 0;
  for (const LightOptions& light : lights) count += emitter_count(light);
  return count;
}

void describe(config::Fields& fields, MeshOptions& options) {
  fields
      .path("file", options.file,
            "Mesh file, or archive.zip!/path/in/it.obj for a file inside an archive.")
      .required();
  if (fields.reading() && !options.file.empty()) {
    const std::string problem = missing_file_problem(options.file);
    fields.expect(problem.empty(), "file", problem);
  }
  fields.choice("up", options.up, {{"y", UpAxis::kY}, {"z", UpAxis::kZ}},
                "Axis of the file that points upwards. y turns the mesh by 90 degrees about x, "
                "before the rotation of its transform; z leaves it as it is.");
  if (fields.reading()) options.is_up_stated = fields.has("up");
  fields.section("transform", options.transform,
                 "Scale, then rotation R = Rz Ry Rx, then translation.");
  fields
      .value("size_m", options.size_m,
             "Size of the bounding box along the axes of the file, in metres; replaces the scale.")
      .above(0);
  fields.choice(
      "anchor", options.anchor,
      {{"origin", Anchor::kOrigin}, {"center", Anchor::kCenter}, {"bottom", Anchor::kBottom}},
      "Point of the mesh that the translation moves to its value: the origin of the file, the "
      "centre of the bounding box, or the middle of its lowest face.");
  fields.value("class", options.class_name,
               "Class of the mesh in masks and labels, a name. An empty one is no class.");
  fields.value(
      "texture", options.texture,
      "Picture or *.texture.yaml that replaces the colours of all materials; the mesh needs "
      "texture coordinates.");
  if (fields.reading() && options.texture) {
    const std::string problem = missing_file_problem(*options.texture);
    fields.expect(problem.empty(), "texture", problem);
  }
  fields.value("texture_seed", options.texture_seed,
               "Seed of a *.texture.yaml in place of the one that the file states: another texture "
               "of the same kind.");
  fields.expect(!options.texture_seed ||
                    (options.texture && options.texture->string().ends_with(".texture.yaml")),
                "texture_seed", "needs a 'texture' that is a *.texture.yaml");
  fields
      .value("reflectance", options.reflectance,
             "Factor of the albedo of all its materials and textures.")
      .range(1e-6, 1e6);
  fields.section(
      "gloss", options.gloss,
      "How all its materials mirror the lights of a scene with lighting: lambertian, beside "
      "what they scatter. By default they do not, or as scene.gloss has it.");
  fields.choice("instances", options.instances,
                {{"whole", Instances::kWhole}, {"nodes", Instances::kNodes}},
                "What masks and labels tell apart: the whole mesh from other meshes, or also the "
                "nodes of its file (the groups or objects of OBJ) from one another.");
  fields.section(
      "trajectory", options.trajectory,
      "Motion of the object, applied after its transform; its time 0 is that of the recording.");
  fields.section("animation", options.animation,
                 "Animation of the file that the mesh plays: its nodes move, and skinned surfaces "
                 "with their bones. Size and anchor are those of its first pose. events.sampling "
                 "must be adaptive, auto or frames.");
  fields.expect(!options.size_m || options.transform.scale == Eigen::Vector3d::Ones(), "size_m",
                "cannot be combined with transform.scale");
}

void describe(config::Fields& fields, SceneOptions& options) {
  fields.section("world", options.world,
                 "A generated scene, beside which no meshes are needed: a room or things of some "
                 "kind around a free ball of 0.8 m at the origin, to be seen along +y.");
  fields.list("meshes", options.meshes, "Meshes of the scene; of a world, further ones.")
      .length(options.world ? 0 : 1, 1'000'000);
  fields.list("more_meshes", options.more_meshes,
              "Meshes that follow those of 'meshes': for overrides that add to a scene. Printed "
              "configurations list them there.");
  if (fields.reading()) append_more_meshes(options);
  fields
      .value("classes", options.classes,
             "Names of the classes 1, 2 and so on in masks and labels; 0 is what has none. By "
             "default the classes that the meshes name, in the order of the meshes.")
      .length(0, kMaxClasses);
  check_classes(fields, options);
  const bool picture = fields.reading() ? fields.form("background") == config::Form::kText
                                        : !options.background_picture.empty();
  const char* const help =
      "Radiance where a ray hits nothing: a number, or an equirectangular picture (its middle "
      "towards +x, its top towards +z).";
  if (picture) {
    fields.path("background", options.background_picture, help);
    if (fields.reading()) {
      const std::string problem = missing_file_problem(options.background_picture);
      fields.expect(problem.empty(), "background", problem);
    }
  } else {
    fields.value("background", options.background, help).at_least(0);
    if (fields.has("background")) options.background_picture.clear();
  }
  fields
      .value("background_yaw_deg", options.background_yaw_deg,
             "Angle by which the background's picture, and that of environment_light, are turned "
             "about the vertical, from +x towards +y, in degrees.")
      .range(-360, 360);
  fields.choice("missing_texture", options.missing_texture,
                {{"error", MissingTexture::kError}, {"grey", MissingTexture::kGrey}},
                "What becomes of a texture that is missing or cannot be decoded: an error, or grey "
                "0.5 with a warning.");
  fields.choice("lighting", options.lighting,
                {{"none", Lighting::kNone}, {"lambertian", Lighting::kLambertian}},
                "Lighting model: none, where the albedo is the radiance, or lambertian.");
  if (options.lighting == Lighting::kNone)
    for (const MeshOptions& mesh : options.meshes)
      fields.expect(!mesh.gloss, "meshes",
                    "must not state 'gloss' without lights to mirror: state lighting: lambertian");
  if (options.lighting == Lighting::kLambertian) describe_lights(fields, options);
}

}  // namespace saccade
