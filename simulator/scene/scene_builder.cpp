#include "simulator/scene/scene_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "core/check.h"
#include "core/error.h"
#include "core/process/progress.h"
#include "simulator/motion/motion.h"
#include "simulator/scene/light/area_light.h"
#include "simulator/scene/mesh/mesh_import.h"
#include "simulator/scene/texture/picture.h"
#include "simulator/scene/triangle_setup.h"
#include "simulator/scene/world/world.h"

namespace saccade {
namespace {

Eigen::AlignedBox3d bounding_box(const Mesh& mesh, const Eigen::Matrix3d& linear) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) box.extend(linear * vertex);
  return box;
}

Eigen::Vector3d scale_to_size(const Eigen::Vector3d& size, const Mesh& mesh) {
  const Eigen::Vector3d extent = bounding_box(mesh, Eigen::Matrix3d::Identity()).sizes();
  return (extent.array() > 0).select(size.cwiseQuotient(extent), Eigen::Vector3d::Ones());
}

Eigen::Vector3d anchor_point(Anchor anchor, const Eigen::AlignedBox3d& box) {
  if (anchor == Anchor::kOrigin) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d center = box.center();
  return anchor == Anchor::kCenter ? center
                                   : Eigen::Vector3d(center.x(), center.y(), box.min().z());
}

/// Turns +y to +z.
Eigen::Matrix3d z_from_y() {
  Eigen::Matrix3d turn;
  turn << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return turn;
}

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

/// Shadow rays start this fraction of the largest body's extent above their surface: ten times what
/// single precision resolves there.
constexpr double kShadowOffset = 1e-6;

Eigen::AlignedBox3f box_of(const PreparedTriangles& triangles) {
  Eigen::AlignedBox3f box;
  for (const Corners& corners : triangles.corners)
    for (const Eigen::Vector3f& corner : corners) box.extend(corner);
  return box;
}

double extent_of(const Eigen::AlignedBox3f& box) {
  return static_cast<double>(box.diagonal().norm() + box.center().norm());
}

/// Corners are rounded to single precision, those of a plane lie on it: a hair of margin for both.
Eigen::AlignedBox3d roomy(const Eigen::AlignedBox3f& box) {
  constexpr double kMargin = 1e-5;
  const Eigen::AlignedBox3d exact = box.cast<double>();
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(kMargin * extent_of(box));
  return {exact.min() - margin, exact.max() + margin};
}

/// The corners of a triangle, whatever their order.
using CornerKey = std::array<std::array<double, 3>, 3>;

CornerKey place_of(const Triangle& triangle, const Mesh& mesh) {
  CornerKey key;
  for (std::size_t k = 0; k < key.size(); ++k) {
    const Eigen::Vector3d& vertex = mesh.vertices[triangle.corners[k]];
    key[k] = {vertex.x(), vertex.y(), vertex.z()};
  }
  std::sort(key.begin(), key.end());
  return key;
}

/// The triangles of a mesh, each place but once. A table of numbers with open addressing: a node for
/// each of a million triangles takes as long as all else that is done with them.
class DistinctPlaces {
 public:
  explicit DistinctPlaces(const Mesh& mesh)
      : mesh_(mesh), table_(std::bit_ceil(2 * mesh.triangles.size() + 1), kFree) {}

  /// False where a triangle inserted before is at the place of triangle `index`.
  [[nodiscard]] bool insert(std::uint32_t index) {
    const CornerKey key = place_of(mesh_.triangles[index], mesh_);
    const std::size_t mask = table_.size() - 1;
    for (std::size_t at = hash_of(key) & mask;; at = (at + 1) & mask) {
      if (table_[at] == kFree) {
        table_[at] = index;
        return true;
      }
      if (place_of(mesh_.triangles[table_[at]], mesh_) == key &&
          move_together(mesh_.triangles[table_[at]], mesh_.triangles[index]))
        return false;
    }
  }

 private:
  static constexpr std::uint32_t kFree = std::numeric_limits<std::uint32_t>::max();

  /// Whether two triangles that share a place in the first pose share one in all.
  [[nodiscard]] bool move_together(const Triangle& a, const Triangle& b) const {
    if (!mesh_.animation) return true;
    return std::ranges::all_of(mesh_.animation->vertices, [&](const auto& vertices) {
      const auto corners = [&](const Triangle& triangle) {
        std::array<std::array<float, 3>, 3> places;
        for (std::size_t k = 0; k < places.size(); ++k) {
          const Eigen::Vector3f& vertex = vertices[triangle.corners[k]];
          places[k] = {vertex.x(), vertex.y(), vertex.z()};
        }
        std::ranges::sort(places);
        return places;
      };
      return corners(a) == corners(b);
    });
  }

  static std::size_t hash_of(const CornerKey& key) {
    std::uint64_t hash = 0;
    for (const std::array<double, 3>& corner : key)
      for (const double value : corner) {
        hash ^= std::bit_cast<std::uint64_t>(value + 0.0);  // both zeros are one place
        hash *= 0x9E3779B97F4A7C15U;
        hash ^= hash >> 32U;
      }
    return hash;
  }

  const Mesh& mesh_;
  std::vector<std::uint32_t> table_;
};

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

/// Numbers the instances of a mesh in the order in which their first triangles come.
class InstanceNumbers {
 public:
  InstanceNumbers(const InstanceLabel& label, const Mesh& mesh, std::uint32_t object,
                  std::vector<SceneInstance>& instances)
      : label_(label), mesh_(mesh), object_(object), instances_(instances) {}

  [[nodiscard]] std::uint16_t of(const Triangle& triangle) {
    const auto [known, is_new] =
        numbers_.try_emplace(label_.splits_nodes ? triangle.node : 0, std::uint16_t{0});
    if (is_new) known->second = append(triangle.node);
    return known->second;
  }

 private:
  std::uint16_t append(std::uint32_t node) {
    if (instances_.size() == kMaxInstances)
      throw InputError("scene.meshes", fmt::format("make more than {} instances", kMaxInstances));
    std::string name = label_.name;
    if (label_.splits_nodes && node < mesh_.nodes.size()) name += "/" + mesh_.nodes[node];
    instances_.push_back({name, label_.file, object_, label_.class_id});
    return static_cast<std::uint16_t>(instances_.size());
  }

  const InstanceLabel& label_;
  const Mesh& mesh_;
  std::uint32_t object_;
  std::vector<SceneInstance>& instances_;
  std::map<std::uint32_t, std::uint16_t> numbers_;  ///< of nodes, or of the whole mesh
};

MeshSurface surface_of(const MeshOptions& options) {
  return {options.texture, options.texture_seed, options.reflectance};
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

Eigen::Affine3d world_from_mesh(const MeshOptions& options, const Mesh& mesh) {
  const Eigen::Vector3d scale =
      options.size_m ? scale_to_size(*options.size_m, mesh) : options.transform.scale;
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  Eigen::Matrix3d rotation = rotation_of(options.transform.rotation_deg);
  if (options.up == UpAxis::kY) rotation *= z_from_y();
  transform.linear() = rotation * scale.asDiagonal();
  transform.translation() = options.transform.translation -
                            anchor_point(options.anchor, bounding_box(mesh, transform.linear()));
  return transform;
}

struct SceneBuilder::Body {
  std::optional<Spline> world_from_body;  ///< none: is static
  std::uint32_t object = 0;               ///< of a moving one
  std::shared_ptr<const VertexAnimation> animation;
  PreparedTriangles opaque, cut_out;
  TriangleId first_opaque = 0, first_cut_out = 0;

  [[nodiscard]] bool is_moving() const { return world_from_body || animation; }
  [[nodiscard]] bool is_empty() const {
    return opaque.corners.empty() && cut_out.corners.empty() && opaque.corner_indices.empty() &&
           cut_out.corner_indices.empty();
  }
  [[nodiscard]] Eigen::AlignedBox3f box() const {
    return animation ? animation->box() : box_of(opaque).merged(box_of(cut_out));
  }
  [[nodiscard]] AnimatedTriangles animated() const {
    return {opaque.corner_indices, cut_out.corner_indices, first_opaque, first_cut_out};
  }
  [[nodiscard]] BvhTriangles occluders() && {
    BvhTriangles source{std::move(opaque.corners), {}};
    source.ids.resize(source.corners.size() + cut_out.corners.size());
    const auto first = source.ids.begin() + static_cast<std::ptrdiff_t>(source.corners.size());
    std::iota(source.ids.begin(), first, first_opaque);
    std::iota(first, source.ids.end(), first_cut_out);
    source.corners.insert(source.corners.end(), cut_out.corners.begin(), cut_out.corners.end());
    return source;
  }
};

SceneBuilder::SceneBuilder() : bodies_(1) {}
SceneBuilder::~SceneBuilder() = default;

std::size_t SceneBuilder::add(const Mesh& mesh, const Eigen::Affine3d& world_from_mesh,
                              const InstanceLabel& label) {
  return add_to(bodies_.front(), mesh, world_from_mesh, label);
}

std::size_t SceneBuilder::add_moving(const Mesh& mesh, const Eigen::Affine3d& object_from_mesh,
                                     Spline world_from_object, const InstanceLabel& label) {
  Body body;
  body.world_from_body = std::move(world_from_object);
  body.object = objects_;
  const std::size_t kept = add_to(body, mesh, object_from_mesh, label);
  if (kept > 0) bodies_.push_back(std::move(body));
  return kept;
}

std::size_t SceneBuilder::add_animated(const Mesh& mesh, const Eigen::Affine3d& object_from_mesh,
                                       const AnimationOptions& animation,
                                       std::optional<Spline> world_from_object,
                                       const InstanceLabel& label) {
  SACCADE_CHECK(mesh.animation != nullptr);
  Body body;
  body.world_from_body = std::move(world_from_object);
  body.object = objects_;
  body.animation =
      std::make_shared<const VertexAnimation>(*mesh.animation, object_from_mesh, animation);
  const std::size_t kept = add_to(body, mesh, object_from_mesh, label);
  if (kept > 0) bodies_.push_back(std::move(body));
  return kept;
}

std::size_t SceneBuilder::add_to(Body& body, const Mesh& mesh,
                                 const Eigen::Affine3d& body_from_mesh,
                                 const InstanceLabel& label) {
  InstanceNumbers numbers(label, mesh, objects_, instances_);
  const TriangleSetup setup(mesh, body_from_mesh, objects_++);
  for (const Material& material : mesh.materials) {
    textures_.push_back(material.texture);
    textures_.push_back(material.opacity);
    if (material.normal_map) normal_maps_.push_back(material.normal_map);
  }
  std::size_t kept = 0;
  DistinctPlaces taken(mesh);
  body.opaque.reserve_more(mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& triangle = mesh.triangles[i];
    const bool is_cut_out = mesh.materials[triangle.material].opacity != nullptr;
    if (!is_cut_out && !taken.insert(i)) continue;
    PreparedTriangles& target = is_cut_out ? body.cut_out : body.opaque;
    if (body.animation)
      setup.add_animated(triangle, target);
    else if (!setup.add(triangle, target))
      continue;
    target.instances.push_back(numbers.of(triangle));
    ++kept;
  }
  return kept;
}

void SceneBuilder::light(double ambient, std::vector<LightOptions> lights,
                         const std::optional<FlickerOptions>& ambient_flicker) {
  is_lit_ = true;
  ambient_ = ambient;
  ambient_flicker_ = ambient_flicker;
  lights_.clear();
  for (const LightOptions& light : lights)
    for (LightOptions& emitter : emitters_of(light)) lights_.push_back(std::move(emitter));
}

Scene SceneBuilder::build(const Background& background) && {
  auto state = std::make_unique<Scene::State>();
  state->background = background;
  state->textures = std::move(textures_);
  PreparedTriangles all = number_triangles();
  SACCADE_CHECK(!all.surfaces.empty());
  if (is_lit_) {
    double extent = 0;
    for (const Body& body : bodies_)
      if (!body.is_empty()) extent = std::max(extent, extent_of(body.box()));
    state->illumination.emplace(ambient_, ambient_flicker_, lights_, kShadowOffset * extent,
                                environment_);
    state->normals = std::move(all.normals);
    set_normal_frames(std::move(all.normal_frames), all.surfaces.size(), *state);
  }
  state->surfaces = std::move(all.surfaces);
  state->interiors = std::move(all.interiors);
  state->cutouts = std::move(all.cutouts);
  state->triangle_instances = std::move(all.instances);
  state->instances = std::move(instances_);
  // After the triangles have their numbers, and before they move on with the bodies.
  for (std::size_t i = 1; i < bodies_.size(); ++i) state->animated.push_back(bodies_[i].animated());
  state->visibility.emplace(make_visibility(*state));
  const Body& still = bodies_.front();
  if (!still.is_empty()) state->size_m = extent_of(still.box());
  for (Body& body : bodies_) state->bvh_triangles.push_back(std::move(body).occluders());
  return Scene(std::move(state));
}

void SceneBuilder::set_normal_frames(std::vector<NormalFrame> frames, std::size_t triangles,
                                     Scene::State& state) const {
  if (frames.empty()) return;
  state.normal_frame_of.assign(triangles, kNoFrame);
  for (std::size_t k = 0; k < frames.size(); ++k)
    state.normal_frame_of[frames[k].triangle] = static_cast<std::uint32_t>(k);
  state.normal_frames = std::move(frames);
  state.normal_maps = normal_maps_;
}

PreparedTriangles SceneBuilder::number_triangles() {
  PreparedTriangles all;
  const auto append = [&all](Body& body, PreparedTriangles Body::*part, std::size_t index) {
    PreparedTriangles& triangles = body.*part;
    if (body.is_moving())
      for (TriangleSurface& surface : triangles.surfaces)
        surface.body = static_cast<std::uint32_t>(index - 1);
    const auto first = static_cast<TriangleId>(all.surfaces.size());
    std::vector<Corners> corners = std::move(triangles.corners);
    std::vector<CornerIndices> indices = std::move(triangles.corner_indices);
    all.append(std::move(triangles));
    triangles.corners = std::move(corners);
    triangles.corner_indices = std::move(indices);
    return first;
  };
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    bodies_[i].first_opaque = append(bodies_[i], &Body::opaque, i);
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    bodies_[i].first_cut_out = append(bodies_[i], &Body::cut_out, i);
  return all;
}

Visibility SceneBuilder::make_visibility(const Scene::State& state) const {
  const auto is_opaque = [&state](const Ray& ray, TriangleId triangle) {
    return state.is_opaque(ray, triangle);
  };
  const auto embree_scene_of = [&](const Body& body) {
    if (body.animation)
      return EmbreeScene(body.animation, {body.opaque.corner_indices, body.first_opaque},
                         {body.cut_out.corner_indices, body.first_cut_out}, is_opaque);
    return EmbreeScene({body.opaque.corners, body.first_opaque},
                       {body.cut_out.corners, body.first_cut_out}, is_opaque);
  };
  std::optional<EmbreeScene> static_triangles;
  if (!bodies_.front().is_empty()) static_triangles.emplace(embree_scene_of(bodies_.front()));
  std::vector<MovingObject> objects;
  std::vector<EmbreeScene> embree_scenes;
  for (std::size_t i = 1; i < bodies_.size(); ++i) {
    const Body& body = bodies_[i];
    objects.emplace_back(body.object, body.world_from_body, roomy(body.box()), body.animation);
    embree_scenes.push_back(embree_scene_of(body));
  }
  return {std::move(static_triangles), std::move(objects), std::move(embree_scenes)};
}

Scene build_scene(const SceneOptions& options, ColourChannel channel) {
  SceneBuilder builder;
  MeshImporter importer({options.missing_texture, options.lighting == Lighting::kLambertian,
                         channel, takes_lights(options), options.normal_maps});
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
    builder.light(options.ambient, std::move(lights), options.ambient_flicker);
    if (options.environment_light)
      builder.light_from_around(read_environment(options, channel, importer.remarks()));
  }
  const Background background = read_background(options, channel, importer.remarks());
  if (channel == ColourChannel::kLuminance)
    for (const std::string& line : importer.remarks().lines()) show_warning(line);
  return std::move(builder).build(background);
}

}  // namespace saccade
