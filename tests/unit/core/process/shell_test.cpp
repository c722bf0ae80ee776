#include "core/process/shell.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace saccade {
namespace {

using ::testing::ElementsAre;
using ::testing::ElementsAreArray;

TEST(ShellLine, IsTakenApartIntoTheSameWords) {
  const std::vector<std::string> words{"saccade", "run",  "a b",    "it's",  "",
                                       "\"x\"",   "a\\b", "~$HOME", "--set", "k={a: 1}"};
  EXPECT_THAT(shell_words(shell_line(words)), ElementsAreArray(words));
}

TEST(ShellWords, AreQuotedAsPeopleDo) {
  EXPECT_THAT(shell_words("  run  -c \"my file.yaml\" a\\ b \"say \\\"x\\\"\" '' \n"),
              ElementsAre("run", "-c", "my file.yaml", "a b", "say \"x\"", ""));
  EXPECT_THAT(shell_words("a 'open quote"), ElementsAre("a", "open quote"));
  EXPECT_TRUE(shell_words(" ").empty());
}

}  // namespace
}  // namespace saccade
