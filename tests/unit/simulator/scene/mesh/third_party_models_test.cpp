#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/error.h"
#include "simulator/scene/mesh/mesh_import.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// Of the Debian package assimp-testmodels.
constexpr const char* kModels = "/usr/share/assimp/models";
constexpr std::size_t kLeastModels = 30;
constexpr std::size_t kLeastFormats = 5;
constexpr std::size_t kMostPerFormat = 12;
constexpr std::uintmax_t kMostBytes = 200'000;

std::vector<fs::path> small_models() {
  const std::set<std::string> endings{".obj", ".gltf", ".glb", ".ply", ".dae", ".stl",
                                      ".off", ".3ds",  ".x",   ".fbx", ".ac"};
  std::vector<fs::path> models;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kModels))
    if (entry.is_regular_file() && endings.contains(entry.path().extension().string()) &&
        entry.file_size() <= kMostBytes)
      models.push_back(entry.path());
  std::ranges::sort(models);
  std::map<std::string, std::size_t> taken;
  std::erase_if(models, [&](const fs::path& model) {
    return ++taken[model.extension().string()] > kMostPerFormat;
  });
  return models;
}

TEST(ThirdPartyModels, LoadOrSayWhatTheyLack) {
  if (!fs::exists(kModels))
    GTEST_SKIP() << kModels << " is missing: apt-get install assimp-testmodels";
  MeshImportOptions options;
  options.missing_texture = MissingTexture::kGrey;
  std::size_t loaded = 0;
  std::set<std::string> formats;
  for (const fs::path& model : small_models()) {
    SCOPED_TRACE(model.string());
    MeshImporter importer(options);
    try {
      const Mesh mesh = importer.read(model);
      EXPECT_FALSE(mesh.triangles.empty());
      for (const Triangle& triangle : mesh.triangles) {
        ASSERT_LT(triangle.material, mesh.materials.size());
        for (const std::uint32_t corner : triangle.corners) ASSERT_LT(corner, mesh.vertices.size());
      }
      ++loaded;
      formats.insert(model.extension().string());
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr(model.filename().string()));
    }
  }
  EXPECT_GE(loaded, kLeastModels);
  EXPECT_GE(formats.size(), kLeastFormats);
}

}  // namespace
}  // namespace saccade
