#pragma once

#include <cmath>
#include <numbers>

#include "core/config/config.h"
#include "core/spline/spline.h"
#include "simulator/scene/build_scene.h"
#include "tests/unit/simulator/scene/animation/gltf_models.h"
#include "tests/unit/simulator/scene/mesh_files.h"

namespace saccade::testing {

/// A test with scenes of animated files.
class AnimatedFiles : public MeshFiles {
 protected:
  /// `keys`: those of the mesh's entry beside its file.
  [[nodiscard]] Scene scene(const GltfModel& model, const std::string& keys = "animation: {}",
                            const std::string& more = "") const {
    write("model.gltf", model.text());
    return build_scene(config::read<SceneOptions>(config::parse(
        "meshes:\n  - {file: model.gltf, up: z, " + keys + "}\n" + more, "scene.yaml", folder_)));
  }
};

/// From z = 2 downwards, x to the right: column u shows x = centre.x + 2 (u - cx) / fx.
inline Rigid3 from_above(const Eigen::Vector2d& centre) {
  return {Eigen::Quaterniond(0, 1, 0, 0), {centre.x(), centre.y(), 2}};
}

/// At rest there.
inline Spline resting_above(const Eigen::Vector2d& centre, double duration_s) {
  const std::vector<StampedPose> poses{{0, from_above(centre)}, {duration_s, from_above(centre)}};
  return Spline::interpolate(poses);
}

/// The square of square_on_node() around the origin, which turns about z with pi rad/s for a
/// second: as a node, or on a bone.
inline GltfModel turning_square(bool on_bone) {
  GltfModel model = square_on_node();
  auto& nodes = model.document["nodes"];
  if (on_bone) {
    model.document["scenes"][0]["nodes"] = {0, 1};
    nodes.push_back({{"name", "bone"}});
    nodes[0]["skin"] = 0;
    const auto inverse_bind =
        model.floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -0.5F, -0.5F, 0, 1}, "MAT4", 16);
    model.document["skins"] = {{{"joints", {1}}, {"inverseBindMatrices", inverse_bind}}};
    auto& attributes = model.document["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = model.add(std::vector<std::uint8_t>(16, 0), "VEC4", 4, 5121);
    attributes["WEIGHTS_0"] =
        model.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 4);
    turn_about_z(model, 1, std::numbers::pi, 2);
  } else {
    nodes[0]["translation"] = {-0.5, -0.5, 0};
    nodes.push_back({{"name", "axle"}, {"children", {0}}});
    model.document["scenes"][0]["nodes"] = {1};
    turn_about_z(model, 1, std::numbers::pi, 2);
  }
  return model;
}

}  // namespace saccade::testing
