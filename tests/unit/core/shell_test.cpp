#include "core/shell.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace saccade {
namespace {

using ::testing::ElementsAre;

TEST(Shell, TakesItsLinesApartAgain) {
  const std::vector<std::string> words{"saccade", "",         "a b", "it's",
                                       "--set",   "k={x: 1}", "''",  "\\"};
  EXPECT_EQ(shell_words(shell_line(words)), words);
}

TEST(Shell, SpacesBetweenWordsAreNoWords) {
  EXPECT_THAT(shell_words("  a   b "), ElementsAre("a", "b"));
  EXPECT_TRUE(shell_words("").empty());
}

}  // namespace
}  // namespace saccade
