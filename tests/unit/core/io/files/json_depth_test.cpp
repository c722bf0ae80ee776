#include "core/io/files/json_depth.h"

#include <gtest/gtest.h>

#include <string>

namespace saccade {
namespace {

TEST(JsonDepth, NamesTheByteThatIsTooDeep) {
  const std::string deepest = std::string(kMostJsonDepth, '[') + std::string(kMostJsonDepth, ']');
  EXPECT_FALSE(json_too_deep_at(deepest));
  EXPECT_EQ(json_too_deep_at("{\"a\": " + deepest + "}"), kMostJsonDepth - 1 + 6);
  EXPECT_EQ(json_too_deep_at(std::string(100'000, '[')), kMostJsonDepth);
}

TEST(JsonDepth, BracketsInTextsAreNone) {
  const std::string text = "{\"" + std::string(1000, '{') + "\\\"[[\": \"\\\\\"}";
  EXPECT_FALSE(json_too_deep_at(text));
}

}  // namespace
}  // namespace saccade
