#include "simulator/scene/scene_options.h"

#include "simulator/scene/scene.h"

#include "core/config/fields.h"
#include "simulator/scene/mesh/file_source.h"
#include "simulator/scene/scene.h"

namespace saccade {

void describe(config::Fields& fields, MeshOptions& options) {
  fields.path("file", options.file, "mesh file, or archive.zip!/path/in/it.obj").required();
  if (fields.reading() && !options.file.empty()) {
    const std::string problem = missing_file_problem(options.file);
    fields.expect(problem.empty(), "file", problem);
  }
  fields.section("transform", options.transform, "scale, then R = Rz Ry Rx, then translation");
  fields
      .value("size_m", options.size_m,
             "size of the bounding box along the file's own axes, instead of a scale")
      .above(0);
  fields.choice(
      "anchor", options.anchor,
      {{"origin", Anchor::kOrigin}, {"center", Anchor::kCenter}, {"bottom", Anchor::kBottom}},
      "what the translation puts in place: the file's origin, or the centre or the "
      "middle of the lowest face of the bounding box");
  fields.section("trajectory", options.trajectory,
                 "motion of the object, after its transform; its time 0 is the recording's");
  fields.expect(!options.size_m || options.transform.scale == Eigen::Vector3d::Ones(), "size_m",
                "cannot be combined with transform.scale");
}

void describe(config::Fields& fields, LightOptions& options) {
  fields.choice("type", options.type,
                {{"point", LightType::kPoint}, {"directional", LightType::kDirectional}},
                "kind of light");
  if (options.type == LightType::kPoint) {
    fields.value("position", options.position, "where it is [m]").required();
  } else {
    fields.value("direction", options.direction, "in which the light travels").required();
    fields.expect(options.direction.norm() > 0, "direction", "must not be zero");
  }
  fields
      .value("intensity", options.intensity,
             "radiance of a white surface facing the light, at 1 m from a point light")
      .at_least(0);
  fields.value("shadows", options.shadows, "whether meshes stand in its way");
}

void describe(config::Fields& fields, SceneOptions& options) {
  fields.list("meshes", options.meshes, "what is in the scene").length(1, 1'000'000);
  const bool picture = fields.reading() ? fields.form("background") == config::Form::kText
                                        : !options.background_picture.empty();
  const char* const help =
      "radiance where nothing is hit: a number, or an equirectangular picture (middle towards "
      "+x, top towards +z)";
  if (picture) {
    fields.path("background", options.background_picture, help).must_exist();
  } else {
    fields.value("background", options.background, help).at_least(0);
    if (fields.has("background")) options.background_picture.clear();
  }
  fields.choice("lighting", options.lighting,
                {{"none", Lighting::kNone}, {"lambertian", Lighting::kLambertian}},
                "none: the albedo is the radiance");
  if (options.lighting == Lighting::kLambertian) {
    fields.value("ambient", options.ambient, "light that comes evenly from everywhere").at_least(0);
    fields.list("lights", options.lights, "lamps and suns, at most 64");
    fields.expect(options.lights.size() <= kMostLamps, "lights", "must be at most 64");
  }
}

}  // namespace saccade
