#include "apps/reference_page.h"
#include "tests/support/source_path.h"

#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace saccade {
namespace {

using config::ReferenceKey;

std::filesystem::path file_of(const std::string& page) {
  return std::filesystem::path(testing::source_path("docs/reference")) / (page + ".md");
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

bool is_scalar_number(const ReferenceKey& key) {
  return key.type.starts_with("number") || key.type == "whole number" ||
         key.type.starts_with("whole number or");
}

TEST(ReferencePages, OnDiskAreThoseOfTheCode) {
  for (const std::string& name : reference_page_names())
    EXPECT_EQ(text_of(file_of(name)), reference_page(name).markdown())
        << file_of(name) << " is stale: run ./dev docs";
}

TEST(ReferencePages, EveryHelpTextIsASentence) {
  for (const std::string& name : reference_page_names()) {
    for (const ReferenceKey& key : reference_page(name).keys) {
      const bool begins =
          !key.help.empty() && std::isupper(static_cast<unsigned char>(key.help[0]));
      EXPECT_TRUE(begins && key.help.ends_with('.'))
          << name << ": " << key.name << ": \"" << key.help << "\" must begin with a capital "
          << "letter and end with a period";
    }
  }
}

TEST(ReferencePages, EveryNumberHasARange) {
  for (const std::string& name : reference_page_names())
    for (const ReferenceKey& key : reference_page(name).keys)
      EXPECT_TRUE(!is_scalar_number(key) || !key.rule.empty())
          << name << ": " << key.name << " has no rule";
}

TEST(ReferencePages, HoldTheKeysOfEveryChoice) {
  const std::string depth = reference_page("depth").markdown();
  for (const char* section : {"## `thesis`", "## `rays`", "## `rays.fusion`"})
    EXPECT_NE(depth.find(section), std::string::npos) << section;
  const std::string simulation = reference_page("simulate").markdown();
  EXPECT_NE(simulation.find("## `scene.meshes[]`"), std::string::npos);
  EXPECT_NE(simulation.find("`trajectory.source: circle`"), std::string::npos);
}

}  // namespace
}  // namespace saccade
