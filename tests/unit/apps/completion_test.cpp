#include "apps/completion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/verbs.h"
#include "core/error.h"

namespace saccade {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::StartsWith;

std::vector<std::string> completed(const std::vector<std::string>& words) {
  CLI::App command;
  add_simulate_verb(command);
  add_run_verb(command);
  add_results_verb(command);
  add_completion_verb(command);
  std::vector<std::string> texts;
  for (const Completion& one : complete(command, words)) texts.push_back(one.text);
  return texts;
}

TEST(CompletionOfWords, AVerb) {
  EXPECT_THAT(completed({"s"}), ElementsAre("simulate"));
  EXPECT_THAT(completed({""}), AllOf(Contains("run"), Contains("results")));
}

TEST(CompletionOfWords, AModule) {
  EXPECT_THAT(completed({"run", "re"}), ElementsAre("reconstruct", "refine"));
  EXPECT_THAT(completed({"run", "--data", "data/walls", "-q", "tr"}), ElementsAre("track"));
  EXPECT_THAT(completed({"run", "track", ""}), IsEmpty());
}

TEST(CompletionOfWords, AnOption) {
  EXPECT_THAT(completed({"run", "track", "--po"}), ElementsAre("--poses-from"));
  EXPECT_THAT(completed({"simulate", "--"}), AllOf(Contains("--seed"), Each(StartsWith("--"))));
}

TEST(CompletionOfWords, AChoiceOfAnOption) {
  EXPECT_THAT(completed({"results", "--format", ""}),
              ElementsAre("table", "csv", "json", "mlflow"));
  EXPECT_THAT(completed({"completion", "z"}), ElementsAre("zsh"));
}

TEST(CompletionOfWords, AShippedConfiguration) {
  EXPECT_THAT(completed({"simulate", "simulation/pla"}),
              ElementsAre("simulation/planes", "simulation/planes_photographs"));
  EXPECT_THAT(completed({"run", "track", "-c", "tracking/f"}),
              ElementsAre("tracking/fast", "tracking/frames"));
  EXPECT_THAT(completed({"run", "depth", "-c", ""}), Each(StartsWith("depth/")));
}

TEST(CompletionOfWords, AKeyOfTheModule) {
  EXPECT_THAT(completed({"simulate", "walls", "--set", "events.contrast_o"}),
              ElementsAre("events.contrast_on=", "events.contrast_off="));
  EXPECT_THAT(completed({"run", "track", "--set", "edges.sam"}), ElementsAre("edges.samples="));
}

TEST(CompletionOfWords, AFileIsLeftToTheShell) {
  EXPECT_THAT(completed({"run", "track", "--data", "da"}), IsEmpty());
  EXPECT_THAT(completed({"unknown", "-"}), IsEmpty());
}

TEST(CompletionScript, OfAnUnknownShellIsAnError) {
  EXPECT_THROW(static_cast<void>(completion_script("tcsh")), InputError);
}

}  // namespace
}  // namespace saccade
