#include "apps/manual.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/verbs.h"

namespace saccade {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// The page of the command ("") or of a verb.
std::string page_of(const std::string& verb) {
  CLI::App command("saccade: simulate.\n");
  add_simulate_verb(command);
  add_convert_verb(command);
  return manual_page(command, verb.empty() ? nullptr : command.get_subcommand(verb));
}

TEST(ManualPage, OfTheCommandListsTheVerbs) {
  const std::string page = page_of("");
  EXPECT_THAT(page, HasSubstr(".SH NAME\nsaccade \\- simulate."));
  EXPECT_THAT(page, HasSubstr(".TP\n\\fBsimulate\\fR\nRender a scene"));
  EXPECT_THAT(page, HasSubstr("\\fBsaccade\\-convert\\fR(1)"));
}

TEST(ManualPage, OfAVerbHasEveryOptionWithItsHelp) {
  CLI::App command;
  add_simulate_verb(command);
  const CLI::App* verb = command.get_subcommand("simulate");
  const std::string page = manual_page(command, verb);
  EXPECT_THAT(page, HasSubstr("\\fBsaccade simulate\\fR \\fICONFIG\\fR"));
  EXPECT_THAT(page, HasSubstr("\\fB\\-o\\fR, \\fB\\-\\-output\\fR \\fIDATASET\\fR"));
  for (const CLI::Option* option : verb->get_options())
    for (const std::string& name : option->get_lnames()) {
      std::string shown;
      for (const char c : "--" + name) shown += c == '-' ? std::string("\\-") : std::string(1, c);
      EXPECT_THAT(page, HasSubstr("\\fB" + shown + "\\fR"));
    }
}

TEST(ManualPage, AMinusIsNoHyphenAndNoTextIsARequest) {
  for (const char* verb : {"", "simulate", "convert"}) {
    const std::string page = page_of(verb);
    EXPECT_THAT(page, Not(HasSubstr(" --")));
    EXPECT_THAT(page, Not(HasSubstr("\n.yaml")));
  }
}

}  // namespace
}  // namespace saccade
