#include "eval/configuration_name.h"

#include <gtest/gtest.h>

namespace saccade {
namespace {

std::string name_of(const std::string& command) {
  RunRecord record;
  record.command = "saccade run track --data walls " + command;
  record.config_yaml = "seed: 1\n";
  return configuration_name(record);
}

TEST(ConfigurationName, IsTheFileWithoutFolderAndEnding) {
  EXPECT_EQ(name_of("-c configs/tracking/best.yaml"), "best");
  EXPECT_EQ(name_of("--config=configs/tracking/best.yaml"), "best");
  EXPECT_EQ(name_of("--config configs/tracking/best.yaml"), "best");
}

TEST(ConfigurationName, HoldsWhatWasSetButNotTheSeed) {
  EXPECT_EQ(name_of("-c best.yaml --set align.samples=9 --set seed=4 --set=last.use=false"),
            "best align.samples=9 last.use=false");
}

TEST(ConfigurationName, SaysWhatWasEstimated) {
  RunRecord record;
  record.command = "saccade run reconstruct --data walls -c best.yaml";
  record.poses_from = "tracked";
  EXPECT_EQ(configuration_name(record), "best, estimated poses");
  record.depth_from = "deep";
  EXPECT_EQ(configuration_name(record), "best, estimated poses, estimated depth");
}

TEST(ConfigurationName, WithoutAFileIsDefaults) { EXPECT_EQ(name_of("-o run"), "defaults"); }

TEST(ConfigurationName, TheFileIsAsTheCommandNamesIt) {
  RunRecord record;
  EXPECT_EQ(configuration_file(record), "");
  record.command = "saccade run track --data walls -c a/best.yaml -c b/best.yaml";
  EXPECT_EQ(configuration_file(record), "b/best.yaml");
}

TEST(ConfigurationName, IsTheHashWhereNoCommandLineMadeTheRun) {
  RunRecord record;
  record.config_yaml = "seed: 1\n";
  EXPECT_EQ(configuration_name(record), configuration_sha256(record).substr(0, 8));
  EXPECT_EQ(configuration_name(record).size(), 8u);
  record.config_yaml.clear();
  EXPECT_EQ(configuration_sha256(record), "");
}

}  // namespace
}  // namespace saccade
