#include "apps/usage_error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "apps/verbs.h"

namespace saccade {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// What the command says about a call that it does not understand.
std::string explained(const std::vector<std::string>& arguments) {
  CLI::App command;
  command.require_subcommand(1);
  add_simulate_verb(command);
  add_run_verb(command);
  add_eval_verb(command);
  add_report_verb(command);
  add_render_verb(command);
  add_info_verb(command);
  add_convert_verb(command);
  try {
    command.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::ParseError& error) {
    return explain_usage_error(command, error, arguments);
  }
  return "understood";
}

TEST(UsageError, SuggestsTheNearestVerb) {
  EXPECT_THAT(explained({"simulat", "walls.yaml"}),
              AllOf(HasSubstr("unknown verb 'simulat'; did you mean 'simulate'?"),
                    HasSubstr("Try: saccade --help")));
}

TEST(UsageError, ListsTheVerbsWhereNoneIsNear) {
  EXPECT_THAT(explained({"frobnicate"}),
              AllOf(HasSubstr("frobnicate"), HasSubstr("valid verbs: simulate, run, eval")));
}

TEST(UsageError, AnUnknownVerbIsOneWhateverFollows) {
  EXPECT_THAT(explained({"simulat", "run"}), HasSubstr("unknown verb 'simulat'"));
}

TEST(UsageError, SuggestsTheNearestOption) {
  EXPECT_THAT(explained({"simulate", "walls.yaml", "--thread", "2"}),
              AllOf(HasSubstr("unknown option '--thread'"), HasSubstr("'--threads'"),
                    HasSubstr("Try: saccade simulate --help")));
  EXPECT_THAT(explained({"info", "data", "--verfiy=yes"}),
              AllOf(HasSubstr("unknown option '--verfiy'"), HasSubstr("'--verify'")));
}

TEST(UsageError, AFileThatIsCalledLikeAVerbIsAFile) {
  EXPECT_THAT(explained({"render", "run", "-o", "x.png", "--fsp", "3"}),
              AllOf(HasSubstr("'--fps'"), HasSubstr("Try: saccade render --help")));
}

TEST(UsageError, NamesWhatIsMissing) {
  EXPECT_THAT(explained({"render", "data"}),
              AllOf(HasSubstr("--output"), HasSubstr("Try: saccade render --help")));
  EXPECT_THAT(explained({"eval", "run", "more"}), HasSubstr("more"));
}

TEST(UsageError, NamesTheValueThatIsWrong) {
  EXPECT_THAT(explained({"simulate", "walls.yaml", "--threads", "two"}),
              HasSubstr("--threads: expected a whole number from 1 to 4096, got 'two'"));
  EXPECT_THAT(explained({"render", "data", "-o", "x.png", "--upscale", "9"}),
              HasSubstr("--upscale: expected a whole number from 1 to 8, got '9'"));
  EXPECT_THAT(explained({"simulate", "walls.yaml", "--seed", "-1"}), HasSubstr("--seed"));
  EXPECT_THAT(explained({"render", "data", "-o", "x.png", "--duration-s", "0"}),
              HasSubstr("--duration-s: expected a finite number above 0, got '0'"));
}

TEST(UsageError, WithoutAVerbPointsToTheHelp) {
  EXPECT_THAT(explained({}), HasSubstr("Try: saccade --help"));
  EXPECT_THAT(explained({""}), HasSubstr("Try: saccade --help"));
  EXPECT_THAT(explained({"--verson"}),
              AllOf(HasSubstr("--verson"), HasSubstr("Try: saccade --help"),
                    Not(HasSubstr("unknown verb"))));
}

}  // namespace
}  // namespace saccade
