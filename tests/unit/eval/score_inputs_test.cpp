#include "eval/score_inputs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "core/io/files/atomic_file.h"
#include "eval/evaluate.h"
#include "tests/unit/eval/fake_folders.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

class ScoreInputsOf : public testing::FakeFolders {
 protected:
  void SetUp() override {
    fs::copy(run(), copy(), fs::copy_options::recursive);
    (void)evaluate_run(copy());
  }

  [[nodiscard]] fs::path copy() const { return folder_.path() / "copy"; }
  [[nodiscard]] std::string stale() const { return staleness(copy(), Dataset::open(dataset())); }

  void append(const char* file) const { std::ofstream(copy() / file, std::ios::app) << "\n"; }

  /// As if another program had scored it.
  void change_recorded(const std::string& name) const {
    ScoreInputs inputs = recorded_inputs(copy());
    ASSERT_TRUE(inputs.contains(name));
    inputs[name] = "another";
    write_atomically(copy() / "metrics.json",
                     to_json(read_json_metrics(copy() / "metrics.json"), inputs));
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(ScoreInputsOf, FreshScoresAreNotStale) {
  EXPECT_EQ(stale(), "");
  EXPECT_EQ(recorded_inputs(copy()), score_inputs(copy(), Dataset::open(dataset())));
}

TEST_F(ScoreInputsOf, ScoringAgainChangesNothing) {
  const std::string before = testing::read_file(copy() / "metrics.json");
  (void)evaluate_run(copy());
  EXPECT_EQ(testing::read_file(copy() / "metrics.json"), before);
}

TEST_F(ScoreInputsOf, ACopyOfARunIsNotStale) {
  TemporaryFolder other;
  fs::copy(copy(), other.path() / "b", fs::copy_options::recursive);
  EXPECT_EQ(staleness(other.path() / "b", Dataset::open(dataset())), "");
}

TEST_F(ScoreInputsOf, AChangedRunIsStale) {
  append("trajectory.txt");
  EXPECT_THAT(stale(), HasSubstr("the run has changed"));
}

TEST_F(ScoreInputsOf, AnotherDatasetOrVersionIsStale) {
  change_recorded("version");
  EXPECT_THAT(stale(), HasSubstr("another version"));
  change_recorded("dataset_sha256");
  EXPECT_THAT(stale(), HasSubstr("dataset"));
}

TEST_F(ScoreInputsOf, WithoutScoresOrWhatTheyAreOfItIsStale) {
  write_atomically(copy() / "metrics.json", "{}\n");
  EXPECT_THAT(stale(), HasSubstr("does not state"));
  fs::remove(copy() / "metrics.json");
  EXPECT_THAT(stale(), HasSubstr("not scored"));
}

}  // namespace
}  // namespace saccade
