#pragma once

#include <span>

#include "simulator/scene/world/world_layout.h"
#include "simulator/scene/world/world_options.h"

namespace saccade {

// Each fills an empty layout, with walls all around. What they draw depends on the layout's seed
// alone.
void build_room(WorldLayout& layout);
void build_corridor(WorldLayout& layout);
void build_layers(WorldLayout& layout);
void build_clutter(WorldLayout& layout);
void build_furniture(WorldLayout& layout);
void build_relief(WorldLayout& layout);
void build_thin(WorldLayout& layout);
void build_moving(WorldLayout& layout);

struct WorldGeometryKind {
  WorldGeometry geometry;
  const char* name;
  const char* help;  ///< part of a sentence
  void (*build)(WorldLayout&);
};

/// All of them: a new one is a function and a row.
[[nodiscard]] std::span<const WorldGeometryKind> world_geometries();
[[nodiscard]] const WorldGeometryKind& find_world_geometry(WorldGeometry geometry);

/// Walls at some distance, before which there is room for things.
[[nodiscard]] WorldShell draw_wide_shell(WorldDice& dice);

/// A place in view: at a distance along y between both, within +-60 degrees to the sides and +-40
/// degrees up and down, uniform in angles and in the logarithm of the distance.
[[nodiscard]] Eigen::Vector3d draw_place_in_view(WorldDice& dice, double near_m, double far_m);

/// A random solid within a ball of that radius.
[[nodiscard]] Mesh draw_solid(WorldDice& dice, double radius, SheetCutter& cutter);

}  // namespace saccade
