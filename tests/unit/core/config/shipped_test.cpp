#include "core/config/shipped.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

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

}  // namespace
}  // namespace saccade::config
