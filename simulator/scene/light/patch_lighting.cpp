#include "simulator/scene/light/patch_lighting.h"

#include <bit>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "simulator/scene/scene_state.h"

namespace saccade {
namespace {

/// Neighbours in a mesh must leave no light between them, whatever the rounding.
constexpr double kLightTolerance = 1e-10;
/// How much wider than a patch the frustum from a light is, for what is seen by a hair beside it.
constexpr double kFrustumMargin = 0.01;
/// A light without a place is taken to be this many sizes of the scene away where its triangles are
/// searched for. Then its rays through a patch spread by a tenth of the patch within the scene,
/// which kFarMargin takes in. Further away the frustum would be so narrow that double precision
/// does not tell its sides apart: 1e-16 of the square of the way, relative to the patch.
constexpr double kFar = 10;
constexpr double kFarMargin = 0.12;

std::array<Eigen::Vector3d, 3> corners_of(const TriangleSurface& surface,
                                          const TriangleInterior& interior) {
  Eigen::Matrix3d rows;
  rows << surface.plane.gradient.transpose(), interior.second.gradient.transpose(),
      interior.third.gradient.transpose();
  const Eigen::Vector3d offsets(surface.plane.offset, interior.second.offset,
                                interior.third.offset);
  const Eigen::Matrix3d inverse = rows.inverse();
  const Eigen::Vector3d first = inverse * -offsets;
  return {first, first + inverse.col(1), first + inverse.col(2)};
}

/// Keeps of a polygon what is not below zero of `side`.
void clip(std::vector<Eigen::Vector3d>& polygon, const AffineForm& side) {
  std::vector<Eigen::Vector3d> kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Eigen::Vector3d& a = polygon[k];
    const Eigen::Vector3d& b = polygon[(k + 1) % polygon.size()];
    const double at_a = side.at(a);
    const double at_b = side.at(b);
    if (at_a >= 0) kept.push_back(a);
    if ((at_a < 0) != (at_b < 0)) kept.emplace_back(a + at_a / (at_a - at_b) * (b - a));
  }
  polygon = std::move(kept);
}

/// Corners around all that frusta see of a triangle.
std::vector<Eigen::Vector3d> patch_corners(const std::array<Eigen::Vector3d, 3>& triangle,
                                           std::span<const Frustum> frusta) {
  std::vector<Eigen::Vector3d> patch;
  for (const Frustum& frustum : frusta) {
    std::vector<Eigen::Vector3d> polygon(triangle.begin(), triangle.end());
    const Eigen::Vector3d axis = frustum.corners[0] + frustum.corners[2];
    for (std::size_t k = 0; k < 4; ++k) {
      Eigen::Vector3d normal = frustum.corners[k].cross(frustum.corners[(k + 1) % 4]);
      if (normal.dot(axis) < 0) normal = -normal;
      clip(polygon, {normal, -normal.dot(frustum.eye)});
    }
    patch.insert(patch.end(), polygon.begin(), polygon.end());
  }
  return patch;
}

/// The narrowest frustum with margin from `eye` around points, of those along their longest extent;
/// none where they are all around it.
std::optional<Frustum> frustum_around(const Eigen::Vector3d& eye,
                                      std::span<const Eigen::Vector3d> points,
                                      double relative_margin) {
  constexpr double kWidest = 0.2;  // cosine
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) axis += (point - eye).normalized();
  axis.normalize();
  std::vector<Eigen::Vector3d> on_plane;
  Eigen::Vector3d longest = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d way = point - eye;
    const double along = way.dot(axis);
    if (!(along > kWidest * way.norm())) return std::nullopt;
    on_plane.emplace_back(way / along - axis);
    if (on_plane.back().squaredNorm() > longest.squaredNorm()) longest = on_plane.back();
  }
  const Eigen::Vector3d right =
      longest.squaredNorm() > 0 ? Eigen::Vector3d(longest.normalized()) : axis.unitOrthogonal();
  const Eigen::Vector3d down = axis.cross(right);
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector3d& point : on_plane)
    box.extend(Eigen::Vector2d(point.dot(right), point.dot(down)));
  const double margin = relative_margin * box.sizes().maxCoeff() + 1e-12;
  const auto corner = [&](double x, double y) -> Eigen::Vector3d {
    return axis + x * right + y * down;
  };
  const Eigen::Vector2d low = box.min().array() - margin;
  const Eigen::Vector2d high = box.max().array() + margin;
  return Frustum{eye,
                 {corner(low.x(), low.y()), corner(high.x(), low.y()), corner(high.x(), high.y()),
                  corner(low.x(), high.y())},
                 0};
}

/// Centre and radius of a sphere around lifted points, with a margin.
std::pair<Eigen::Vector3d, double> sphere_around(std::span<const Eigen::Vector3d> points,
                                                 const Eigen::Vector3d& shadow_offset) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 0;
  for (const Eigen::Vector3d& point : points) centre += point + shadow_offset;
  centre /= static_cast<double>(points.size());
  for (const Eigen::Vector3d& point : points)
    radius = std::max(radius, (point + shadow_offset - centre).norm());
  radius *= 1 + 2 * kFrustumMargin;
  return {centre, radius};
}

/// Of the light with this bit.
std::size_t index_of(LightSet bit) { return static_cast<std::size_t>(std::countr_zero(bit)); }

/// Adds margin for the rounding between neighbours to the edges.
Occluder with_tolerance(Occluder occluder, double scale) {
  for (std::size_t k = 0; k < 3; ++k) occluder.forms[k].offset += kLightTolerance * scale;
  return occluder;
}

/// In the light from `position`: the edges' forms as EdgeFunctions has them from there.
Occluder point_light_occluder(TriangleId triangle, const EdgeFunctions& pass,
                              const Eigen::Vector3d& position, const Eigen::Vector3d& patch) {
  const double sign = pass.depth > 0 ? 1 : -1;
  const auto form = [&](const Eigen::Vector3d& gradient, double offset) -> AffineForm {
    return {sign * gradient, sign * (offset - gradient.dot(position))};
  };
  return with_tolerance({{form(pass.edges[0], 0), form(pass.edges[1], 0), form(pass.edges[2], 0),
                          form(pass.w, -pass.depth)},
                         triangle},
                        std::abs(pass.w.dot(patch - position)));
}

/// In parallel light from the direction `to_light`: where the path there intersects the plane, each
/// form is what it is at the path's foot plus the path's fraction of it.
Occluder directional_light_occluder(TriangleId triangle, const TriangleSurface& surface,
                                    const TriangleInterior& interior,
                                    const Eigen::Vector3d& to_light) {
  const double slope = surface.plane.gradient.dot(to_light);
  const AffineForm distance{-surface.plane.gradient / slope, -surface.plane.offset / slope};
  const auto shifted = [&](const AffineForm& form) -> AffineForm {
    const double rate = form.gradient.dot(to_light);
    return {form.gradient + rate * distance.gradient, form.offset + rate * distance.offset};
  };
  const AffineForm second = shifted(interior.second);
  const AffineForm third = shifted(interior.third);
  const AffineForm first{-second.gradient - third.gradient, 1 - second.offset - third.offset};
  return with_tolerance({{first, second, third, distance}, triangle}, 1);
}

}  // namespace

LightSet PatchLighting::lights_at(const Eigen::Vector3d& point) const {
  LightSet lights = unoccluded;
  const Eigen::Vector3d start = point + shadow_offset;
  for (const PartlyOccludedLight& light : partly_occluded) {
    bool is_lit = true;
    light.lanes.visit_candidates({start, start, start}, [&](std::size_t i) {
      is_lit = !light.occluders[i].occludes(start);
      return is_lit;
    });
    if (is_lit) lights |= light.bit;
  }
  return lights;
}

std::optional<Occluder> Scene::State::make_occluder(TriangleId triangle, const LightOptions& light,
                                                    const Eigen::Vector3d& patch) const {
  if (light.has_position()) {
    const EdgeFunctions pass =
        edge_functions(triangle, light.position, Eigen::Matrix3d::Identity());
    if (pass.depth == 0) return std::nullopt;
    return point_light_occluder(triangle, pass, light.position, patch);
  }
  const TriangleSurface& surface = surfaces[triangle];
  if (surface.plane.gradient.dot(light.direction) == 0) return std::nullopt;
  return directional_light_occluder(triangle, surface, interiors[triangle], -light.direction);
}

bool Scene::State::collect_occluders(const LightOptions& light,
                                     std::span<const Eigen::Vector3d> patch,
                                     const Eigen::Vector3d& shadow_offset, const AffineForm& front,
                                     std::size_t most, std::vector<TriangleId>& found) {
  // Paths begin at the lifted points, which in a large scene are far from a small patch.
  std::vector<Eigen::Vector3d> around(patch.begin(), patch.end());
  for (const Eigen::Vector3d& point : patch) around.emplace_back(point + shadow_offset);
  const Eigen::Vector3d eye = light.has_position()
                                  ? light.position
                                  : Eigen::Vector3d(patch[0] - kFar * size_m * light.direction);
  const auto frustum =
      frustum_around(eye, around, light.has_position() ? kFrustumMargin : kFarMargin);
  found.clear();
  return frustum && bvhs.front().collect({&*frustum, 1}, front, most, found) &&
         std::all_of(found.begin(), found.end(), [&](TriangleId triangle) {
           return triangle < surfaces.size() - cutouts.size();
         });
}

bool Scene::State::find_lighting(const Patch& patch, std::size_t most, PatchLighting& lighting) {
  const AffineForm& plane = surfaces[patch.triangle].plane;
  const double offset = illumination->shadow_offset();
  lighting.shadow_offset = offset * patch.side * plane.gradient;
  lighting.unoccluded = 0;
  lighting.partly_occluded.clear();
  // Paths to lights begin above the surface: what reaches less high cannot be in them.
  const AffineForm front{patch.side * plane.gradient, patch.side * plane.offset - 0.5 * offset};
  const std::span<const LightOptions> lights = illumination->lights();
  const auto [centre, radius] = sphere_around(patch.corners, lighting.shadow_offset);
  std::vector<TriangleId> found;
  for (std::size_t k = 0; k < lights.size(); ++k) {
    const double height = lights[k].has_position() ? plane.at(lights[k].position)
                                                   : -plane.gradient.dot(lights[k].direction);
    if (!(patch.side * height > 0) || illumination->misses(k, centre, radius)) continue;
    found.clear();
    if (lights[k].shadows &&
        !collect_occluders(lights[k], patch.corners, lighting.shadow_offset, front, most, found))
      return false;
    add_light(LightSet{1} << k, patch, found, lighting);
  }
  return true;
}

void Scene::State::find_lighting(const Patch& patch, const TriangleLighting& whole,
                                 PatchLighting& lighting) const {
  lighting.shadow_offset =
      illumination->shadow_offset() * patch.side * surfaces[patch.triangle].plane.gradient;
  lighting.unoccluded = whole.unoccluded;
  lighting.partly_occluded.clear();
  const auto [centre, radius] = sphere_around(patch.corners, lighting.shadow_offset);
  for (const OccluderCandidates& light : *whole.candidates)
    if (!illumination->misses(index_of(light.bit), centre, radius))
      add_light(light.bit, patch, light.triangles, lighting);
}

void Scene::State::add_light(LightSet bit, const Patch& patch, std::span<const TriangleId> found,
                             PatchLighting& lighting) const {
  PartlyOccludedLight light{bit, {}, {}};
  const LightOptions& options = illumination->lights()[index_of(bit)];
  if (!select_occluders(options, patch, lighting.shadow_offset, found, light.occluders)) return;
  if (light.occluders.empty()) {
    lighting.unoccluded |= bit;
    return;
  }
  double reach_m = 0;
  for (const Eigen::Vector3d& corner : patch.corners)
    reach_m = std::max(reach_m, (corner - patch.corners[0]).norm());
  light.lanes = OccluderLanes(patch.corners[0] + lighting.shadow_offset, 2 * reach_m);
  for (const Occluder& occluder : light.occluders) light.lanes.add(occluder.forms);
  lighting.partly_occluded.push_back(std::move(light));
}

bool Scene::State::select_occluders(const LightOptions& light, const Patch& patch,
                                    const Eigen::Vector3d& shadow_offset,
                                    std::span<const TriangleId> found,
                                    std::vector<Occluder>& occluders) const {
  const auto& corners = patch.corners;
  const auto [centre, radius] = sphere_around(corners, shadow_offset);
  for (const TriangleId triangle : found) {
    const auto occluder = make_occluder(triangle, light, corners[0]);
    if (!occluder) continue;
    bool covers = true;
    const bool is_beside =
        std::any_of(occluder->forms.begin(), occluder->forms.end(),
                    [&, &centre = centre, &radius = radius](const AffineForm& form) {
                      const double middle = form.at(centre);
                      const double reach = radius * form.gradient.norm();
                      if (std::abs(middle) > reach) {
                        covers = covers && middle > 0;
                        return middle < 0;
                      }
                      double low = std::numeric_limits<double>::infinity();
                      double high = -low;
                      for (const Eigen::Vector3d& corner : corners) {
                        const double value = form.at(corner + shadow_offset);
                        low = std::min(low, value);
                        high = std::max(high, value);
                      }
                      const double margin = kFrustumMargin * (high - low);
                      covers = covers && low > margin;
                      return high + margin <= 0;
                    });
    if (is_beside) continue;
    if (covers) return false;
    occluders.push_back(*occluder);
  }
  return true;
}

const TriangleLighting& Scene::State::triangle_lighting(TriangleId triangle, double side) {
  constexpr std::size_t kSimple = 6;
  constexpr std::size_t kMax = 96;
  std::call_once(triangle_lightings_built, [this] {
    triangle_lightings = std::make_unique<TriangleLighting[]>(2 * surfaces.size());
  });
  TriangleLighting& whole = triangle_lightings[2 * triangle + (side > 0 ? 1 : 0)];
  std::call_once(whole.found, [&] {
    const auto corners = corners_of(surfaces[triangle], interiors[triangle]);
    PatchLighting lighting;
    if (!find_lighting({triangle, side, {corners.begin(), corners.end()}}, kMax, lighting)) return;
    std::size_t count = 0;
    for (const PartlyOccludedLight& light : lighting.partly_occluded)
      count += light.occluders.size();
    if (count <= kSimple) {
      whole.lighting = std::make_unique<const PatchLighting>(std::move(lighting));
      return;
    }
    whole.candidates =
        std::make_unique<std::vector<OccluderCandidates>>(lighting.partly_occluded.size());
    whole.unoccluded = lighting.unoccluded;
    for (std::size_t k = 0; k < lighting.partly_occluded.size(); ++k) {
      (*whole.candidates)[k].bit = lighting.partly_occluded[k].bit;
      for (const Occluder& occluder : lighting.partly_occluded[k].occluders)
        (*whole.candidates)[k].triangles.push_back(occluder.triangle);
    }
  });
  return whole;
}

bool Scene::find_lighting_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                  const Eigen::Vector3d& eye, TriangleId triangle, LightSet lights,
                                  PatchLighting& lighting) const {
  constexpr double kAround = 1e-5;  // of the way from the eye: far above the rounding of a search
  constexpr std::size_t kMost = 8192;
  if (!state_->illumination || !moving_objects().empty()) return false;
  const Illumination& illumination = *state_->illumination;
  const AffineForm& plane = state_->surfaces[triangle].plane;
  const double side = plane.at(eye) > 0 ? 1 : -1;
  const Eigen::Vector3d way = to - from;
  const Eigen::Vector3d along =
      kAround * (from - eye).norm() *
      (way.squaredNorm() > 0 ? way.normalized() : plane.gradient.unitOrthogonal());
  const Eigen::Vector3d across = plane.gradient.cross(along);
  const Patch patch{
      triangle,
      side,
      {from - along - across, from - along + across, to + along + across, to + along - across}};
  lighting.shadow_offset = illumination.shadow_offset() * side * plane.gradient;
  lighting.unoccluded = 0;
  lighting.partly_occluded.clear();
  const AffineForm front{side * plane.gradient,
                         side * plane.offset - 0.5 * illumination.shadow_offset()};
  std::vector<TriangleId> found;
  for (LightSet open = lights; open != 0; open &= open - 1) {
    const LightOptions& light = illumination.lights()[index_of(open)];
    const double height =
        light.has_position() ? plane.at(light.position) : -plane.gradient.dot(light.direction);
    if (!(side * height > 0)) continue;
    found.clear();
    if (light.shadows && !state_->collect_occluders(light, patch.corners, lighting.shadow_offset,
                                                    front, kMost, found))
      return false;
    state_->add_light(open & ~(open - 1), patch, found, lighting);
  }
  return true;
}

const PatchLighting* Scene::find_lighting(TriangleId triangle, std::span<const Frustum> frusta,
                                          std::size_t most, PatchLighting& lighting) const {
  if (!state_->illumination || !moving_objects().empty()) return nullptr;
  const AffineForm& plane = state_->surfaces[triangle].plane;
  const double side = plane.at(frusta.front().eye) > 0 ? 1 : -1;
  for (const Frustum& frustum : frusta)
    if (!(side * plane.at(frustum.eye) > 0)) return nullptr;
  const TriangleLighting& whole = state_->triangle_lighting(triangle, side);
  if (whole.lighting) return whole.lighting.get();
  const Patch patch{
      triangle, side,
      patch_corners(corners_of(state_->surfaces[triangle], state_->interiors[triangle]), frusta)};
  if (patch.corners.empty()) return nullptr;
  if (whole.candidates)
    state_->find_lighting(patch, whole, lighting);
  else if (!state_->find_lighting(patch, most, lighting))
    return nullptr;
  return &lighting;
}

}  // namespace saccade
