#include "eval/evaluate_events.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/io/events/event_file.h"
#include "tests/support/command.h"

namespace saccade {
namespace {
namespace fs = std::filesystem;

fs::path write_events(const fs::path& file, const Events& events) {
  const auto writer = make_event_writer(file, TimestampUnit::kNanoseconds, {8, 6});
  writer->append(events);
  writer->close();
  return file;
}

class EvaluateEvents : public ::testing::Test {
 protected:
  testing::TemporaryFolder folder_;
  Events truth_{{1'000, 1, 2, 1}, {2'000'000, 3, 4, -1}, {3'000'000, 1, 2, 1}};
};

TEST_F(EvaluateEvents, WritesScoresAndAPicture) {
  const fs::path truth = write_events(folder_.path() / "truth.h5", truth_);
  const fs::path found = write_events(folder_.path() / "found.txt", {truth_[0], truth_[2]});
  const Metrics scores = evaluate_events({found, truth, {}}, folder_.path() / "scores");
  EXPECT_EQ(scores.get("events.precision_10us"), 1);
  EXPECT_DOUBLE_EQ(*scores.get("events.recall_10us"), 2.0 / 3);
  EXPECT_EQ(read_json_metrics(folder_.path() / "scores" / "metrics.json"), scores);
  EXPECT_TRUE(fs::exists(folder_.path() / "scores" / "pixels.png"));
}

TEST_F(EvaluateEvents, APartIsCutFromBoth) {
  const fs::path truth = write_events(folder_.path() / "truth.h5", truth_);
  const fs::path found = write_events(folder_.path() / "found.h5", {truth_[0]});
  const Metrics scores = evaluate_events({found, truth, {0.0, 0.001}});
  EXPECT_EQ(scores.get("events.true_count"), 1);
  EXPECT_EQ(scores.get("events.recall_10us"), 1);
}

TEST_F(EvaluateEvents, ADurationBeginsAtTheFirstEventOfBoth) {
  const fs::path truth = write_events(folder_.path() / "truth.h5", truth_);
  const fs::path found = write_events(folder_.path() / "found.h5", {truth_[1], truth_[2]});
  const Metrics scores = evaluate_events({found, truth, {std::nullopt, 0.0025}});
  EXPECT_EQ(scores.get("events.true_count"), 2);
  EXPECT_EQ(scores.get("events.precision_10us"), 1) << "the last event is in neither part";
}

TEST_F(EvaluateEvents, AnEventBeyondAnySensorIsAnError) {
  const fs::path truth = write_events(folder_.path() / "truth.h5", truth_);
  const fs::path far = folder_.write("far.txt", "0.0001 65535 65535 1\n");
  EXPECT_THROW(static_cast<void>(evaluate_events({far, truth, {}})), InputError);
}

TEST_F(EvaluateEvents, RefusesWhatCannotBeCompared) {
  const fs::path truth = write_events(folder_.path() / "truth.h5", truth_);
  EXPECT_THROW(static_cast<void>(evaluate_events({folder_.path() / "no.h5", truth, {}})),
               InputError);
  EXPECT_THROW(static_cast<void>(evaluate_events({truth, truth, {5.0, 1.0}})), InputError);
}

}  // namespace
}  // namespace saccade
