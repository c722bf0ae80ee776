#include "apps/command_line.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/command.h"

namespace saccade {
namespace {

using testing::run_command;

std::string line_of(const std::vector<std::string>& arguments) {
  std::vector<const char*> argv = {"/usr/bin/saccade"};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  set_command_line(static_cast<int>(argv.size()), argv.data());
  return command_line();
}

TEST(CommandLine, PlainWordsStayPlain) {
  EXPECT_EQ(line_of({"simulate", "configs/walls.yaml", "-o", "data/walls_2", "--set",
                     "duration_s=0.5", "--seed", "+7"}),
            "saccade simulate configs/walls.yaml -o data/walls_2 --set duration_s=0.5 --seed +7");
}

TEST(CommandLine, WithoutArgumentsIsTheCommandAlone) { EXPECT_EQ(line_of({}), "saccade"); }

TEST(CommandLine, OtherWordsAreQuoted) {
  EXPECT_EQ(line_of({"my data", "", "it's"}), R"(saccade 'my data' '' 'it'\''s')");
}

TEST(CommandLine, AShellReadsTheSameWords) {
  const std::vector<std::string> words = {
      "a b",
      "",
      "'",
      "''x'",
      "\"",
      "$HOME",
      "`id`",
      "~",
      "*",
      "a;b",
      "a&b",
      "a|b",
      "#c",
      "!1",
      "\\",
      "\\n",
      "line\nbreak",
      "tab\there",
      "camera={width: 8, height: 6}",
      "(x)",
      "<in>",
      "Büro",
  };
  // "saccade" becomes the printer of one word per line, ended by a bar.
  const std::string script = "saccade() { printf '%s|' \"$@\"; }; " + line_of(words);
  std::string expected;
  for (const std::string& word : words) expected += word + "|";
  EXPECT_EQ(run_command("/bin/sh", {"-c", script}).output, expected);
}

}  // namespace
}  // namespace saccade
