#include "simulator/scene/world/world_pictures.h"

#include <fmt/format.h>

#include <array>
#include <string>
#include <vector>

namespace saccade {
namespace {

struct PicturePackage {
  const char* package;
  const char* folder;
  std::vector<const char*> files;
};

/// Those with detail all over, sharp and without transparency.
const std::array kPhotographs{
    PicturePackage{"mate-backgrounds",
                   "/usr/share/backgrounds/mate/",
                   {
                       "nature/Blinds.jpg",
                       "nature/Dune.jpg",
                       "nature/FreshFlower.jpg",
                       "nature/Garden.jpg",
                       "nature/GreenMeadow.jpg",
                       "nature/LadyBird.jpg",
                       "nature/RainDrops.jpg",
                       "nature/TwoWings.jpg",
                       "nature/Wood.jpg",
                       "nature/YellowFlower.jpg",
                       "abstract/Elephants.jpg",
                   }},
    PicturePackage{"lomiri-wallpapers-16.04",
                   "/usr/share/backgrounds/",
                   {
                       "Bridge_by_Sander_Klootwijk.jpg",
                       "Dragonfly_by_Bolly.jpg",
                       "Picture_0B_by_freespace.jpg",
                       "Picture_1A_by_freespace.jpg",
                       "Wine_by_Jakkub_Mede.jpg",
                       "aitzgorri_by_Aitzol_Berasategi.jpg",
                       "analogpattern_by_Peter_Nerlich.jpg",
                       "friends_by_Aitzol_Berasategi.jpg",
                       "greentock_by_Peter_Nerlich.jpg",
                       "life_by_Aitzol_Berasategi.jpg",
                       "picosdeeuropa_by_Aitzol_Berasategi.jpg",
                       "seeding_by_Clements_Engelhardt.jpg",
                       "sunset_by_Aitzol_Berasategi.jpg",
                   }},
};

const std::array kDrawings{
    PicturePackage{"openclipart-png",
                   "/usr/share/openclipart/png/",
                   {
                       "animals/birds/manager_mimooh_01.png",
                       "animals/bugs/bee2_mimooh_01.png",
                       "animals/bugs/butterfly_jonathan_dietr_01.png",
                       "animals/bugs/punaisa_01.png",
                       "animals/fantasy/troll_daniel_steele_r.png",
                       "animals/mammals/bears/orso_architetto_francesc_01.png",
                       "animals/mammals/big_cats/tiger_graig_ryan_smith_-_01.png",
                       "animals/mammals/elefante01_architetto_fr_01.png",
                       "animals/mammals/horses/horse_1_konstantin_r._01.png",
                       "buildings/carnegie_library_building_01.png",
                       "buildings/homes/home12.png",
                       "buildings/homes/home9.png",
                       "education/books/help-books-aj.svg_aj_ash_01.png",
                       "education/paint.png",
                       "food/desserts/cake1_jarno_vasamaa_01.png",
                       "food/fruit/grape_01.png",
                       "food/fruit/strawberry.png",
                       "food/fruit/turkey_platter_01_with_fruit_and_vegitables_01.png",
                       "food/menu_example1.png",
                       "food/menu_example4.png",
                       "people/beach_trip_ganson.png",
                       "people/fireman_enrique_meza_c_01.png",
                       "people/hikinh_ganson.png",
                       "people/water_fight_ganson1.png",
                       "plants/fall_coloured_tree_geral_01.png",
                       "plants/flowers/geranium_ganson.png",
                       "plants/flowers/pink-rose_tess_brady_01.png",
                       "plants/flowers/sun_flower_ganson.png",
                       "plants/trees/fern_mo_01.png",
                       "recreation/games/8ball_form_jarno_vasama.png",
                       "recreation/games/chess/chess_game_01.png",
                       "recreation/holiday/fireworks_ganson2.png",
                       "recreation/holiday/thanksgiving/thanksgiving_spread_01.png",
                       "recreation/music/guitar_jarno_vasamaa1.png",
                       "recreation/music/harp2_ganson.png",
                       "recreation/music/violin_mo_01.png",
                       "recreation/religion/creation_day_3_number_ge_01.png",
                       "recreation/religion/creation_day_6_number_ge_01.png",
                       "recreation/religion/daedalus_and_ikarus_pete_01.png",
                       "recreation/toys/abc_blocks_petri_lummema_01.png",
                       "recreation/toys/teddybear_jarno_vasamaa_.png",
                       "tools/natural_gas_pump_well_jo_01.png",
                       "transportation/boating/boat_jarno_vasamaa1.png",
                       "transportation/hummer_01.png",
                       "transportation/truck_jarno_vasamaa1.png",
                       "transportation/vehicles/bicycle_01.png",
                   }},
};

template <class Packages>
std::vector<WorldPicture> pictures_of(const Packages& packages) {
  std::vector<WorldPicture> pictures;
  for (const PicturePackage& package : packages)
    for (const char* file : package.files)
      pictures.push_back({std::string(package.folder) + file, package.package});
  return pictures;
}

}  // namespace

std::string missing_picture_problem(const WorldPicture& picture) {
  if (std::filesystem::is_regular_file(picture.file)) return {};
  return fmt::format("{} is missing: it is in the Debian package {}; apt-get install {}",
                     picture.file.string(), picture.package, picture.package);
}

std::span<const WorldPicture> world_photographs() {
  static const std::vector<WorldPicture> pictures = pictures_of(kPhotographs);
  return pictures;
}

std::span<const WorldPicture> world_drawings() {
  static const std::vector<WorldPicture> pictures = pictures_of(kDrawings);
  return pictures;
}

}  // namespace saccade
