#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "simulator/scene/world/cabinetry.h"
#include "simulator/scene/world/world_geometry.h"
#include "simulator/scene/world/world_shapes.h"

namespace saccade {
namespace {

using Eigen::Vector3d;

constexpr std::uint64_t kFurnitureStream = 2700;
constexpr const char* kFurnitureFolder = "/usr/share/sweethome3d/furniture/";

struct FurnitureModel {
  const char* file;
  std::array<double, 3>
      size_m;     ///< width, height and depth, as the archives' catalogues state them
  bool is_small;  ///< stands on a pedestal
};

constexpr FurnitureModel kModels[] = {
    {"BlendSwap-CC-0.sh3f!/blendswap-cc-0/augalas/augalas.obj", {0.609, 0.315, 0.349}, true},
    {"BlendSwap-CC-0.sh3f!/blendswap-cc-0/bookcase/bookcase.obj", {0.919, 1.472, 0.365}, false},
    {"BlendSwap-CC-0.sh3f!/blendswap-cc-0/cuckooClock/cuckooClock.obj",
     {0.266, 0.738, 0.177},
     true},
    {"BlendSwap-CC-0.sh3f!/blendswap-cc-0/desklamp/desklamp.obj", {0.244, 0.4, 0.244}, true},
    {"BlendSwap-CC-0.sh3f!/blendswap-cc-0/electricGuitar/electricGuitar.obj",
     {0.345, 1.1, 0.321},
     false},
    {"BlendSwap-CC-0.sh3f!/blendswap-cc-0/largeFridge/largeFridge.obj",
     {0.925, 1.84, 0.806},
     false},
    {"BlendSwap-CC-0.sh3f!/blendswap-cc-0/littlePlant/littlePlant.obj",
     {0.266, 0.232, 0.266},
     true},
    {"BlendSwap-CC-0.sh3f!/blendswap-cc-0/oakTable/oakTable.obj", {1.24, 0.741, 1.24}, false},
    {"BlendSwap-CC-0.sh3f!/blendswap-cc-0/plant/plant.obj", {0.818, 1.171, 0.69}, false},
    {"BlendSwap-CC-0.sh3f!/blendswap-cc-0/sillaBlanca/sillaBlanca.obj",
     {0.505, 0.85, 0.584},
     false},
    {"BlendSwap-CC-0.sh3f!/blendswap-cc-0/tableWithTablecloth/tableWithTablecloth.obj",
     {0.803, 0.75, 0.812},
     false},
    {"BlendSwap-CC-0.sh3f!/blendswap-cc-0/wardrobeWithSlidingDoors/wardrobeWithSlidingDoors.obj",
     {2, 2.36, 0.66},
     false},
    {"BlendSwap-CC-0.sh3f!/blendswap-cc-0/whiteBoard/whiteBoard.obj", {1.247, 1.29, 0.551}, false},
    {"BlendSwap-CC-0.sh3f!/blendswap-cc-0/winchesterArmchair/winchesterArmchair.obj",
     {1.12, 0.804, 0.934},
     false},
    {"BlendSwap-CC-BY.sh3f!/blendswap-cc-by/bedsideTable/bedsideTable.obj",
     {0.5, 0.48, 0.414},
     false},
    {"BlendSwap-CC-BY.sh3f!/blendswap-cc-by/bunkBed/bunkBed.obj", {1.13, 1.6, 2.05}, false},
    {"BlendSwap-CC-BY.sh3f!/blendswap-cc-by/kitchenChair/kitchenChair.obj",
     {0.43, 0.91, 0.44},
     false},
    {"BlendSwap-CC-BY.sh3f!/blendswap-cc-by/kitchenSink/kitchenSink.obj",
     {0.976, 0.976, 0.616},
     false},
    {"BlendSwap-CC-BY.sh3f!/blendswap-cc-by/largeStove/largeStove.obj",
     {1.04, 0.852, 0.723},
     false},
    {"BlendSwap-CC-BY.sh3f!/blendswap-cc-by/plaidChair/plaidChair.obj", {0.405, 0.8, 0.426}, false},
    {"BlendSwap-CC-BY.sh3f!/blendswap-cc-by/spider_plant/spider_plant.obj",
     {0.666, 0.342, 0.636},
     true},
    {"BlendSwap-CC-BY.sh3f!/blendswap-cc-by/yuccaPlant/yuccaPlant.obj", {1.079, 1.8, 1.024}, false},
    {"KatorLegaz.sh3f!/katorlegaz/apple-imac-1998/apple-imac-1998.obj", {0.425, 0.401, 0.5}, true},
    {"KatorLegaz.sh3f!/katorlegaz/cafe-table/cafe-table.obj", {0.742, 0.7, 0.742}, false},
    {"KatorLegaz.sh3f!/katorlegaz/full-bookcase/full-bookcase.obj", {0.898, 2.21, 0.347}, false},
    {"KatorLegaz.sh3f!/katorlegaz/mid-century-sofa/mid-century-sofa.obj", {1.99, 0.8, 0.84}, false},
    {"KatorLegaz.sh3f!/katorlegaz/propane-stove/propane-stove.obj", {0.6, 0.584, 0.596}, false},
    {"Scopia.sh3f!/scopia/apple_pc/apple_pc.obj", {0.44, 0.38, 0.362}, true},
    {"Scopia.sh3f!/scopia/burlap_sofa/burlap_sofa.obj", {1.7, 0.797, 0.9}, false},
    {"Scopia.sh3f!/scopia/dining_room/dining_room.obj", {2.56, 1.75, 0.364}, false},
    {"Scopia.sh3f!/scopia/dressing-table/dressing-table.obj", {0.857, 1.36, 0.465}, false},
    {"Scopia.sh3f!/scopia/fireplace1/fireplace1.obj", {1.15, 1.05, 0.351}, false},
    {"Scopia.sh3f!/scopia/inkjet_and_scanner_printer/inkjet_and_scanner_printer.obj",
     {0.446, 0.189, 0.332},
     true},
    {"Scopia.sh3f!/scopia/kids_desk_table/kids_desk_table.obj", {1.12, 0.746, 0.605}, false},
    {"Scopia.sh3f!/scopia/little_lamp3/little_lamp3.obj", {0.41, 0.728, 0.41}, true},
    {"Scopia.sh3f!/scopia/maceta/maceta.obj", {0.59, 0.58, 0.65}, true},
    {"Scopia.sh3f!/scopia/office_chair/office_chair.obj", {0.635, 1, 0.637}, false},
    {"Scopia.sh3f!/scopia/open-cardboard-box/open-cardboard-box.obj", {0.35, 0.25, 0.3}, true},
    {"Scopia.sh3f!/scopia/vase1/vase1.obj", {0.15, 0.2, 0.15}, true},
    {"Scopia.sh3f!/scopia/water_cooler/water_cooler.obj", {0.274, 1.322, 0.318}, false},
};

WorldShell draw_hall(WorldDice& dice) {
  WorldShell shell;
  shell.front = dice.between(3.8, 6.5);
  shell.back = dice.between(1.5, 2.5);
  shell.left = dice.between(2.5, 4.5);
  shell.right = dice.between(2.5, 4.5);
  shell.down = dice.between(1.05, 1.5);
  shell.up = dice.between(1.3, 2.0);
  shell.turn = dice.between(-0.4, 0.4);
  return shell;
}

MeshOptions furniture_mesh(const FurnitureModel& model, const Vector3d& foot, double yaw_deg) {
  MeshOptions options;
  options.file = std::string(kFurnitureFolder) + model.file;
  options.up = UpAxis::kY;
  options.is_up_stated = true;
  options.size_m = Vector3d(model.size_m.data());
  options.anchor = Anchor::kBottom;
  options.transform.translation = foot;
  options.transform.rotation_deg = {0, 0, yaw_deg};
  return options;
}

}  // namespace

void build_furniture(WorldLayout& layout) {
  // Each model is read once, so that more of the same cost little.
  constexpr int kDifferent = 12, kPieces = 20, kAttempts = 160;
  WorldDice dice = layout.dice(kFurnitureStream);
  layout.close(draw_hall(dice));
  const WorldShell& shell = layout.shell();
  std::array<const FurnitureModel*, kDifferent> models{};
  for (auto& model : models)
    model = &kModels[dice.integer(0, static_cast<int>(std::size(kModels)) - 1)];
  constexpr double kAbove_m = 0.003;  // the floor, which feet do not share
  for (int attempt = 0, placed = 0; attempt < kAttempts && placed < kPieces; ++attempt) {
    const FurnitureModel& model =
        *models[static_cast<std::size_t>(dice.integer(0, kDifferent - 1))];
    const auto& [width, height, depth] = model.size_m;
    const double radius = 0.5 * std::hypot(width, depth);
    Vector3d foot = draw_place_in_view(dice, 1.1, shell.front);
    const double pedestal = model.is_small ? dice.between(0.5, 1.1) : 0;
    foot.z() = -shell.down + kAbove_m + pedestal;
    const Vector3d middle(foot.x(), foot.y(), 0);
    const Eigen::AlignedBox3d around(
        Vector3d(foot.x() - radius, foot.y() - radius, -shell.down),
        Vector3d(foot.x() + radius, foot.y() + radius, foot.z() + height));
    if (foot.z() + height > shell.up || !layout.is_inside(middle, std::min(radius, 0.9)) ||
        !layout.is_clear(around, Eigen::Isometry3d::Identity()) || !layout.take(middle, radius))
      continue;
    layout.add_file(furniture_mesh(model, foot, dice.between(-180.0, 180.0)));
    if (model.is_small) {
      Mesh mesh;
      const double side = std::max(width, depth);
      add_block(mesh, {-0.5 * side, -0.5 * side, -kFootDepth_m},
                {side, side, pedestal + kFootDepth_m}, layout.cutter());
      layout.add("pedestal", std::move(mesh),
                 placed_at({foot.x(), foot.y(), -shell.down}, turn_by_slope(dice.between(-2, 2))));
    }
    ++placed;
  }
}

}  // namespace saccade
