#pragma once

#include "simulator/scene/mesh/mesh.h"
#include "simulator/scene/world/sheet_cutter.h"
#include "simulator/scene/world/world_dice.h"

namespace saccade {

/// Furniture made of boxes. It stands on z = -kFootDepth_m, so that no face lies in that of the
/// floor it is put on; its back is towards +y.
struct Cabinet {
  const char* name = "";
  Mesh mesh;
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  ///< of the box around it, which begins at z = 0
};

constexpr double kFootDepth_m = 0.01;

/// A cupboard, a table, a shelf or a chair.
[[nodiscard]] Cabinet draw_cabinet(WorldDice& dice, SheetCutter& cutter);

/// A box of that size whose lowest corner is at `low`.
void add_block(Mesh& mesh, const Eigen::Vector3d& low, const Eigen::Vector3d& size,
               SheetCutter& cutter);

}  // namespace saccade
