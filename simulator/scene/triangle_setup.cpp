#include "simulator/scene/triangle_setup.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/check.h"

namespace saccade {
namespace {

/// Twice the area below this fraction of the longest edge's square counts as none.
constexpr double kLeastArea = 1e-12;

/// The form that has these values at the corners.
AffineForm through(const TriangleInterior& interior, const Eigen::Vector3d& values) {
  const double second = values[1] - values[0];
  const double third = values[2] - values[0];
  return {second * interior.second.gradient + third * interior.third.gradient,
          values[0] + second * interior.second.offset + third * interior.third.offset};
}

struct TexelForms {
  AffineForm x, y;
};

/// Texel coordinates x = u W - 0.5, y = (1 - v) H - 0.5. Repeated textures are shifted by whole
/// periods towards their first one, where reading is fastest.
TexelForms texel_forms(const Texture& texture, const std::vector<Eigen::Vector2d>& uvs,
                       const Triangle& triangle, const TriangleInterior& interior) {
  Eigen::Vector3d x, y;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector2d& uv = uvs[triangle.corners[static_cast<std::size_t>(i)]];
    x[i] = uv.x() * texture.width();
    y[i] = (1 - uv.y()) * texture.height();
  }
  const auto shift = [](Eigen::Vector3d& values, int size, Wrap wrap) {
    if (wrap == Wrap::kRepeat) values.array() -= size * std::floor(values.minCoeff() / size);
    values.array() -= 0.5;
  };
  shift(x, texture.width(), texture.wrap_u());
  shift(y, texture.height(), texture.wrap_v());
  return {through(interior, x), through(interior, y)};
}

}  // namespace

void PreparedTriangles::append(PreparedTriangles&& other) {
  const auto first = static_cast<std::uint32_t>(surfaces.size());
  for (NormalFrame& frame : other.normal_frames) frame.triangle += first;
  for (GlossyTriangle& triangle : other.glossy) triangle.number += first;
  saccade::append(glossy, std::move(other.glossy));
  saccade::append(normal_frames, std::move(other.normal_frames));
  saccade::append(corners, std::move(other.corners));
  saccade::append(corner_indices, std::move(other.corner_indices));
  saccade::append(surfaces, std::move(other.surfaces));
  saccade::append(interiors, std::move(other.interiors));
  saccade::append(normals, std::move(other.normals));
  saccade::append(cutouts, std::move(other.cutouts));
  saccade::append(instances, std::move(other.instances));
}

void PreparedTriangles::reserve(std::size_t count) {
  surfaces.reserve(count);
  interiors.reserve(count);
  normals.reserve(count);
  instances.reserve(count);
}

TriangleSetup::TriangleSetup(const Mesh& mesh, const Eigen::Affine3d& body_from_mesh,
                             std::uint32_t object)
    : mesh_(mesh), object_(object), normal_matrix_(body_from_mesh.linear().inverse().transpose()) {
  for (const std::size_t size : {mesh.normals.size(), mesh.uvs.size(), mesh.colours.size()})
    SACCADE_CHECK(size == 0 || size == mesh.vertices.size());
  vertices_.reserve(mesh.vertices.size());
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    vertices_.emplace_back(body_from_mesh * vertex);
  if (std::ranges::any_of(mesh.materials,
                          [](const Material& m) { return m.normal_map != nullptr; }))
    tangents_.emplace(mesh, vertices_, body_from_mesh.linear());
}

bool TriangleSetup::add(const Triangle& triangle, PreparedTriangles& target) const {
  const Eigen::Vector3d& a = vertices_[triangle.corners[0]];
  const Eigen::Vector3d to_b = vertices_[triangle.corners[1]] - a;
  const Eigen::Vector3d to_c = vertices_[triangle.corners[2]] - a;
  const Eigen::Vector3d normal = to_b.cross(to_c);
  const double squared = normal.squaredNorm();
  const double longest =
      std::max({to_b.squaredNorm(), to_c.squaredNorm(), (to_c - to_b).squaredNorm()});
  if (!(std::sqrt(squared) > kLeastArea * longest)) return false;

  const auto form = [&a](const Eigen::Vector3d& gradient) {
    return AffineForm{gradient, -gradient.dot(a)};
  };
  const AffineForm plane = form(normal.normalized());
  const TriangleInterior interior{form(to_c.cross(normal) / squared),
                                  form(normal.cross(to_b) / squared)};
  target.corners.push_back({a.cast<float>(), vertices_[triangle.corners[1]].cast<float>(),
                            vertices_[triangle.corners[2]].cast<float>()});
  target.surfaces.push_back(surface(triangle, plane, interior));
  target.interiors.push_back(interior);
  target.normals.push_back(shading_normals(triangle, plane.gradient));
  add_gloss(triangle, target);
  if (mesh_.materials[triangle.material].normal_map) {
    target.normal_frames.push_back(normal_frame(triangle, interior, target.normals.back()));
    target.normal_frames.back().triangle = static_cast<std::uint32_t>(target.surfaces.size() - 1);
  }
  if (const Texture* opacity = mesh_.materials[triangle.material].opacity.get()) {
    const TexelForms forms = texel_forms(*opacity, mesh_.uvs, triangle, interior);
    target.cutouts.push_back({forms.x, forms.y, opacity});
  }
  return true;
}

void TriangleSetup::add_animated(const Triangle& triangle, PreparedTriangles& target) const {
  // Forms of the weights of the second and the third corner.
  const TriangleInterior weights{{Eigen::Vector3d::UnitX(), 0}, {Eigen::Vector3d::UnitY(), 0}};
  target.corner_indices.push_back(triangle.corners);
  target.surfaces.push_back(surface(triangle, {}, weights));
  target.interiors.push_back(weights);
  target.normals.push_back(ShadingNormals{});
  add_gloss(triangle, target);
  if (const Texture* opacity = mesh_.materials[triangle.material].opacity.get()) {
    const TexelForms forms = texel_forms(*opacity, mesh_.uvs, triangle, weights);
    target.cutouts.push_back({forms.x, forms.y, opacity});
  }
}

void TriangleSetup::add_gloss(const Triangle& triangle, PreparedTriangles& target) const {
  const Gloss& gloss = mesh_.materials[triangle.material].gloss;
  if (!gloss.is_matt())
    target.glossy.push_back({static_cast<TriangleId>(target.surfaces.size() - 1), gloss});
}

TriangleSurface TriangleSetup::surface(const Triangle& triangle, const AffineForm& plane,
                                       const TriangleInterior& interior) const {
  const Material& material = mesh_.materials[triangle.material];
  TriangleSurface surface{plane, {}, {}, material.texture.get(), material.factor, object_};
  surface.self_light = material.self_light;
  if (material.texture != nullptr) {
    SACCADE_CHECK(!mesh_.uvs.empty());
    const TexelForms forms = texel_forms(*material.texture, mesh_.uvs, triangle, interior);
    surface.x = forms.x;
    surface.y = forms.y;
  } else if (!mesh_.colours.empty()) {
    const auto colour = [&](std::size_t i) { return mesh_.colours[triangle.corners[i]]; };
    surface.x = through(interior, {colour(0), colour(1), colour(2)});
  } else {
    surface.x.offset = material.albedo;
  }
  return surface;
}

NormalFrame TriangleSetup::normal_frame(const Triangle& triangle, const TriangleInterior& interior,
                                        const ShadingNormals& normals) const {
  const NormalTexture& map = *mesh_.materials[triangle.material].normal_map;
  const TexelForms forms = texel_forms(map.part(0), mesh_.normal_uvs, triangle, interior);
  const Eigen::Vector3d plane_normal =
      interior.second.gradient.cross(interior.third.gradient).normalized();
  // The tangents belong to the normals that the mesh states, which may be turned over here: then
  // the whole vector is, so that the map's hollows stay hollows.
  const double first_side = side_of(triangle, 0, plane_normal);
  const VertexTangents::Corners corners =
      tangents_->of(triangle, first_side * normals[0].cast<double>());
  NormalFrame frame{
      forms.x, forms.y, {}, static_cast<float>(first_side * corners.handedness), &map};
  for (std::size_t i = 0; i < frame.tangents.size(); ++i)
    frame.tangents[i] = (side_of(triangle, i, plane_normal) * corners.tangents[i]).cast<float>();
  return frame;
}

double TriangleSetup::side_of(const Triangle& triangle, std::size_t corner,
                              const Eigen::Vector3d& plane_normal) const {
  // A mirrored mesh winds its triangles the other way.
  if (mesh_.normals.empty()) return normal_matrix_.determinant() < 0 ? -1 : 1;
  const Eigen::Vector3d stated = normal_matrix_ * mesh_.normals[triangle.corners[corner]];
  return stated.dot(plane_normal) < 0 ? -1 : 1;
}

ShadingNormals TriangleSetup::shading_normals(const Triangle& triangle,
                                              const Eigen::Vector3d& plane_normal) const {
  ShadingNormals normals;
  for (std::size_t i = 0; i < 3; ++i) {
    Eigen::Vector3d normal = plane_normal;
    if (!mesh_.normals.empty()) {
      const Eigen::Vector3d stated = normal_matrix_ * mesh_.normals[triangle.corners[i]];
      // Many files wind their faces against their normals.
      if (stated.norm() > 0)
        normal = stated.normalized() * (stated.dot(plane_normal) < 0 ? -1.0 : 1.0);
    }
    normals[i] = normal.cast<float>();
  }
  return normals;
}

}  // namespace saccade
