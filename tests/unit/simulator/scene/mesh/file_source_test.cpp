#include "simulator/scene/mesh/file_source.h"

#include <gmock/gmock.h>

#include "simulator/scene/mesh/mesh_import.h"
#include "tests/support/error_of.h"
#include "tests/unit/simulator/scene/mesh_files.h"

namespace saccade {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(FileSource, MissingFilesOfDebianPackagesNameThem) {
  EXPECT_THAT(missing_file_problem("/usr/share/games/openarena/baseoa/pak4-textures.no!/a.jpg"),
              HasSubstr("apt-get install openarena-081-textures"));
  EXPECT_THAT(missing_file_problem("/usr/share/backgrounds/life_by_nobody.jpg"),
              HasSubstr("apt-get install lomiri-wallpapers-16.04"));
  EXPECT_THAT(missing_file_problem("/usr/share/backgrounds/of_another_package.jpg"),
              HasSubstr("does not exist"));
}

using FileSourceFiles = testing::MeshFiles;

TEST_F(FileSourceFiles, AMaterialNamesThePackageOfItsTexture) {
  write("square.mtl", "newmtl surface\nmap_Kd /usr/share/backgrounds/mate/no_such_picture.jpg\n");
  const auto square = write("square.obj", testing::square_obj("square.mtl"));
  EXPECT_THAT(testing::error_of([&] { static_cast<void>(MeshImporter().read(square)); }),
              AllOf(HasSubstr("square.obj"), HasSubstr("apt-get install mate-backgrounds")));
}

}  // namespace
}  // namespace saccade
