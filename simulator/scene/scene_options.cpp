#include "simulator/scene/scene_options.h"

#include "core/config/fields.h"
#include "simulator/scene/mesh/file_source.h"
#include "simulator/scene/scene.h"

namespace saccade {

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
  fields.section(
      "trajectory", options.trajectory,
      "Motion of the object, applied after its transform; its time 0 is that of the recording.");
  fields.expect(!options.size_m || options.transform.scale == Eigen::Vector3d::Ones(), "size_m",
                "cannot be combined with transform.scale");
}

void describe(config::Fields& fields, LightOptions& options) {
  fields.choice("type", options.type,
                {{"point", LightType::kPoint}, {"directional", LightType::kDirectional}},
                "Kind of light.");
  if (options.type == LightType::kPoint) {
    fields.value("position", options.position, "Position of the light, in metres.")
        .range(-1e6, 1e6)
        .required();
  } else {
    fields.value("direction", options.direction, "Direction in which the light travels.")
        .range(-1e6, 1e6)
        .required();
    fields.expect(options.direction.norm() > 0, "direction", "must not be zero");
  }
  fields
      .value("intensity", options.intensity,
             "Radiance of a white surface that faces the light, at a distance of 1 m from a point "
             "light.")
      .at_least(0);
  fields.value("shadows", options.shadows, "Whether meshes cast shadows in this light.");
  fields.section("flicker", options.flicker,
                 "Flicker of the light, whose mean over a period is its intensity.");
}

void describe(config::Fields& fields, SceneOptions& options) {
  fields.list("meshes", options.meshes, "Meshes of the scene.").length(1, 1'000'000);
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
  fields.choice("missing_texture", options.missing_texture,
                {{"error", MissingTexture::kError}, {"grey", MissingTexture::kGrey}},
                "What becomes of a texture that is missing or cannot be decoded: an error, or grey "
                "0.5 with a warning.");
  fields.choice("lighting", options.lighting,
                {{"none", Lighting::kNone}, {"lambertian", Lighting::kLambertian}},
                "Lighting model: none, where the albedo is the radiance, or lambertian.");
  if (options.lighting == Lighting::kLambertian) {
    fields
        .value("ambient", options.ambient,
               "Radiance of a white surface in the ambient light alone.")
        .at_least(0);
    fields.section(
        "ambient_flicker", options.ambient_flicker,
        "Flicker of the ambient light: in a room, that of the lamps whose light the walls "
        "scatter.");
    fields.list("lights", options.lights, "Point lights and directional lights, at most 64.");
    fields.expect(options.lights.size() <= kMaxLights, "lights", "must be at most 64");
  }
}

}  // namespace saccade
