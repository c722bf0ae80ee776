#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "core/config/config.h"
#include "core/error.h"
#include "simulator/preview.h"
#include "tests/support/source_path.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLeastScenes = 12;
constexpr const char* kFast = "_fast";

std::vector<std::string> catalogue_names() {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry :
       fs::directory_iterator(fs::path(testing::source_path("configs/simulation/catalogue"))))
    names.push_back(entry.path().stem().string());
  std::ranges::sort(names);
  return names;
}

TEST(Catalogue, EverySceneHasTwoTrajectories) {
  const std::vector<std::string> names = catalogue_names();
  std::size_t scenes = 0;
  for (const std::string& name : names) {
    if (name.ends_with(kFast)) continue;
    EXPECT_TRUE(std::ranges::find(names, name + kFast) != names.end()) << name;
    ++scenes;
  }
  EXPECT_GE(scenes, kLeastScenes);
  EXPECT_EQ(2 * scenes, names.size());
}

/// Parameter: a scene whose files are in Debian packages, below configs/simulation.
class CatalogueScene : public ::testing::TestWithParam<std::string> {};

/// The sensor's pictures are small enough to look at in a unit test, and large enough to estimate a
/// rate within the factor that the bounds leave.
TEST_P(CatalogueScene, SeesTextureAndNoWallFromWithin) {
  const fs::path file =
      fs::path(testing::source_path("configs/simulation")) / (GetParam() + ".yaml");
  ScenePreview seen;
  try {
    const auto config = config::read<SimulationConfig>(config::load(file.string(), {}));
    EXPECT_EQ(config.events.texture_filter, TextureFilter::kMipmap);
    seen = preview(config, 3, 16);
  } catch (const InputError& error) {
    const std::string problem = error.what();
    ASSERT_NE(problem.find("apt-get install"), std::string::npos) << problem;
    GTEST_SKIP() << problem;
  }
  for (const PreviewView& view : seen.views) {
    EXPECT_GT(view.nearest_m, 0.1) << view.pose.t_s;
    EXPECT_GT(view.events_per_s, 1e4) << view.pose.t_s;
  }
}

std::vector<std::string> scenes_of_packages() {
  std::vector<std::string> names{"walls_brick", "planes_photographs", "boxes_wood", "dunes_sand"};
  for (const std::string& name : catalogue_names()) names.push_back("catalogue/" + name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(All, CatalogueScene, ::testing::ValuesIn(scenes_of_packages()),
                         [](const auto& scene) { return fs::path(scene.param).stem().string(); });

}  // namespace
}  // namespace saccade
