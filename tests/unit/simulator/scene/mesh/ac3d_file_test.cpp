#include "simulator/scene/mesh/ac3d_file.h"

#include <gmock/gmock.h>

#include "core/error.h"
#include "simulator/scene/mesh/mesh_import.h"
#include "tests/unit/simulator/scene/mesh_files.h"

namespace saccade {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A triangle with these texture lines, in a group beside an object without faces.
std::string ac3d(const std::string& textures) {
  return "AC3Db\n"
         "MATERIAL \"\" rgb 1 1 1 amb 1 1 1 emis 0 0 0 spec 0 0 0 shi 0 trans 0\n"
         "OBJECT world\nkids 2\n"
         "OBJECT poly\nname \"empty\"\nnumvert 3\n0 0 5\n1 0 5\n0 1 5\nkids 0\n"
         "OBJECT poly\nname \"triangle\"\n" +
         textures +
         "numvert 3\n0 0 0\n1 0 0\n0 1 0\nnumsurf 1\nSURF 0x20\nmat 0\nrefs 3\n"
         "0 0 0\n1 1 0\n2 0 1\nkids 0\n";
}

class Ac3dFile : public testing::MeshFiles {
 protected:
  std::string seen_by_assimp(const std::string& text) const {
    const std::filesystem::path file = write("track.acc", text);
    const ReplacedFiles replaced = ac3d_for_assimp(FileSource(), file);
    if (replaced.empty()) return text;
    EXPECT_EQ(replaced.begin()->first, file.generic_string());
    const Bytes& bytes = replaced.begin()->second;
    return {bytes.begin(), bytes.end()};
  }
};

TEST_F(Ac3dFile, KeepsTheFirstPictureOfAnObject) {
  const std::string seen = seen_by_assimp(
      ac3d("texture empty_texture_no_mapping base\ntexture \"road.png\" base\n"
           "texture \"shadow.png\" tiled\ntexture empty_texture_no_mapping skids\n"));
  EXPECT_EQ(seen, ac3d("texture \"road.png\" base\n"));
}

TEST_F(Ac3dFile, LeavesOtherFilesAlone) {
  const std::filesystem::path one = write("one.ac", ac3d("texture \"road.png\"\n"));
  EXPECT_TRUE(ac3d_for_assimp(FileSource(), one).empty());
  const std::filesystem::path other = write("a.obj", ac3d("texture \"a\"\ntexture \"b\"\n"));
  EXPECT_TRUE(ac3d_for_assimp(FileSource(), other).empty());
}

TEST_F(Ac3dFile, LayersAndObjectsWithoutFacesDoNotKeepATrackFromLoading) {
  const std::filesystem::path file = write(
      "track.acc", ac3d("texture \"road.png\" base\ntexture empty_texture_no_mapping skids\n"));
  MeshImporter importer({MissingTexture::kGrey, false});
  EXPECT_EQ(importer.read(file).triangles.size(), 1U);
  const std::vector<std::string> remarks = importer.remarks().lines();
  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_THAT(remarks.front(), HasSubstr("road.png"));
}

}  // namespace
}  // namespace saccade
