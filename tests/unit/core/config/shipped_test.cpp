#include "core/config/shipped.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <string>

#include "core/config/config.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"
#include "tests/support/source_path.h"

namespace saccade::config {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// An empty folder as the working folder, while this lives.
class Elsewhere {
 public:
  Elsewhere() : before_(fs::current_path()) { fs::current_path(folder_.path()); }
  ~Elsewhere() { fs::current_path(before_); }
  Elsewhere(const Elsewhere&) = delete;
  Elsewhere& operator=(const Elsewhere&) = delete;

 private:
  saccade::testing::TemporaryFolder folder_;
  fs::path before_;
};

fs::path walls() { return saccade::testing::source_path("configs/simulation/walls.yaml"); }

TEST(ShippedConfigurations, AreFoundFromTheBuildTree) {
  EXPECT_TRUE(fs::equivalent(shipped_folder(), saccade::testing::source_path(".")));
  const std::vector<std::string> names = shipped_configurations();
  EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
  EXPECT_THAT(names, ::testing::Contains("tracking/fast"));
}

TEST(ShippedConfigurations, AreNamedInFullOrInShort) {
  const Elsewhere elsewhere;
  for (const char* name :
       {"walls", "simulation/walls", "simulation/walls.yaml", "configs/simulation/walls.yaml"})
    EXPECT_TRUE(fs::equivalent(find_configuration(name), walls())) << name;
  const std::string adapter = "examples/external/constant_velocity.yaml";
  EXPECT_TRUE(fs::equivalent(find_configuration(adapter), saccade::testing::source_path(adapter)));
}

TEST(ShippedConfigurations, GiveWayToAFileOfTheUser) {
  const Elsewhere elsewhere;
  std::ofstream("walls") << "duration_s: 1\n";
  EXPECT_EQ(find_configuration("walls"), "walls");
  EXPECT_EQ(find_configuration("/absent/walls"), "/absent/walls");
}

TEST(ShippedConfigurations, AreNotHiddenByAFolder) {
  const Elsewhere elsewhere;
  fs::create_directory("walls");
  EXPECT_TRUE(fs::equivalent(find_configuration("walls"), walls()));
}

TEST(ShippedConfigurations, ANameOfSeveralListsThem) {
  const Elsewhere elsewhere;
  EXPECT_THAT(saccade::testing::error_of([] { return find_configuration("thesis"); }),
              HasSubstr("depth/thesis, mosaic/thesis"));
}

TEST(ShippedConfigurations, AnUnknownNameIsAnErrorWithTheNearest) {
  const Elsewhere elsewhere;
  EXPECT_THAT(saccade::testing::error_of([] { return load("wals"); }),
              HasSubstr("did you mean 'walls'?"));
  EXPECT_THAT(saccade::testing::error_of([] { return load("configs/tracking/acurate.yaml"); }),
              HasSubstr("did you mean 'tracking/accurate'?"));
}

struct Named {
  fs::path scene;
  std::optional<fs::path> method;
};

void describe(Fields& fields, Named& named) {
  fields.configuration("scene", named.scene, "A scene.").required();
  fields.configuration("method", named.method, "A method.");
}

/// What a file with this text names.
Named named_by(const std::string& text, const fs::path& folder = fs::current_path()) {
  std::ofstream(folder / "named.yaml") << text;
  return read<Named>(load(folder / "named.yaml"));
}

TEST(ShippedConfigurations, AreNamedByOtherFiles) {
  const Elsewhere elsewhere;
  const Named named = named_by("scene: walls\nmethod: tracking/best\n");
  EXPECT_TRUE(fs::equivalent(named.scene, walls()));
  EXPECT_TRUE(fs::equivalent(named.method.value(),
                             saccade::testing::source_path("configs/tracking/best.yaml")));
  EXPECT_FALSE(named_by("scene: walls\nmethod: ~\n").method);
}

TEST(ShippedConfigurations, GiveWayToAFileBesideTheOneThatNamesIt) {
  const Elsewhere elsewhere;
  const fs::path folder = fs::current_path() / "study";
  fs::create_directory(folder);
  std::ofstream("walls") << "of the working folder, which a file does not depend on\n";
  EXPECT_TRUE(fs::equivalent(named_by("scene: walls\n", folder).scene, walls()));
  std::ofstream(folder / "walls") << "duration_s: 1\n";
  EXPECT_EQ(named_by("scene: walls\n", folder).scene, folder / "walls");
}

TEST(ShippedConfigurations, AFileThatNamesNoneIsToldTheNearest) {
  const Elsewhere elsewhere;
  EXPECT_THAT(saccade::testing::error_of([] { return named_by("\nscene: wals\n"); }),
              ::testing::AllOf(HasSubstr("named.yaml:2: scene: no such file '"),
                               HasSubstr("did you mean 'walls'?")));
  EXPECT_THAT(saccade::testing::error_of([] { return named_by("scene: thesis\n"); }),
              ::testing::AllOf(HasSubstr("named.yaml:1: scene: "),
                               HasSubstr("depth/thesis, mosaic/thesis")));
  EXPECT_THAT(saccade::testing::error_of([] { return named_by("method: tracking/best\n"); }),
              HasSubstr("scene"));
}

}  // namespace
}  // namespace saccade::config
