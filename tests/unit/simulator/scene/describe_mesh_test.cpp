#include "simulator/scene/describe_mesh.h"

#include <gmock/gmock.h>

#include "core/config/config.h"
#include "tests/unit/simulator/scene/mesh_files.h"

namespace saccade {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

using DescribeMesh = testing::MeshFiles;

TEST_F(DescribeMesh, SaysSizeTrianglesAndAnEntryThatStandsItUpright) {
  const std::string text = describe_mesh(write("square.obj", testing::square_obj()));
  EXPECT_THAT(text, HasSubstr("[1, 1, 0] from [0, 0, 0] to [1, 1, 0]"));
  EXPECT_THAT(text, HasSubstr("2 triangles"));
  EXPECT_THAT(text, HasSubstr("square.obj', up: z}"));
  EXPECT_THAT(text, HasSubstr("does not say which axis is up"));
  EXPECT_THAT(text, Not(HasSubstr("hardly metres")));
}

TEST_F(DescribeMesh, SaysWhichTextureIsMissing) {
  write("square.mtl", "newmtl surface\nmap_Kd wood.png\n");
  const std::string text = describe_mesh(write("square.obj", testing::square_obj("square.mtl")));
  EXPECT_THAT(text, HasSubstr("wood.png does not exist"));
}

TEST_F(DescribeMesh, DoubtsTheUnitsOfAModelAsLargeAsATown) {
  const std::string text =
      describe_mesh(write("large.obj", "v 0 0 0\nv 20000 0 0\nv 0 20000 0\nf 1 2 3\n"));
  EXPECT_THAT(text, HasSubstr("hardly metres"));
}

TEST_F(DescribeMesh, CountsTheTrianglesOfAFileThatIsUsedTwice) {
  write("square.obj", testing::square_obj());
  const auto options = config::read<SceneOptions>(
      config::parse("meshes:\n"
                    "  - {file: square.obj}\n"
                    "  - {file: square.obj, transform: {translation: [0, 0, 1]}}\n",
                    "scene.yaml", folder_));
  const std::string text = describe_scene(options);
  EXPECT_THAT(text, HasSubstr("2 meshes from 1 files, 4 triangles"));
}

TEST(MeshName, IsThatOfAFormatWithSurfaces) {
  EXPECT_TRUE(is_mesh_name("chair.glb"));
  EXPECT_TRUE(is_mesh_name("rooms.zip!/chair/Chair.OBJ"));
  EXPECT_TRUE(is_mesh_name("dunes.relief.yaml"));
  EXPECT_TRUE(is_mesh_name("robot.wrl"));  // which cannot be read, and the error says so
  EXPECT_FALSE(is_mesh_name("events.h5"));
  EXPECT_FALSE(is_mesh_name("events.raw"));
  EXPECT_FALSE(is_mesh_name("events.txt"));
  EXPECT_FALSE(is_mesh_name("data/walls"));
}

}  // namespace
}  // namespace saccade
