#include "eval/evaluate_events.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/io/dataset/dataset_writer.h"
#include "core/io/events/event_file.h"
#include "core/io/events/labels_h5.h"
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

/// A dataset with 100,000 events, one every 10 us, of 48 pixels in turn and of both polarities; every
/// tenth is of shot noise, the others are of the signal.
Events write_labelled_dataset(const fs::path& folder) {
  Events events;
  EventLabels labels;
  labels.resize(100'000);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const std::size_t pixel = i % 48;
    events.push_back({static_cast<TimeNs>(i) * 10'000, static_cast<std::uint16_t>(pixel % 8),
                      static_cast<std::uint16_t>(pixel / 8),
                      static_cast<std::int8_t>(i / 48 % 2 == 0 ? 1 : -1)});
    labels.origin[i] = i % 10 == 3 ? 2 : 0;
  }
  DatasetWriter writer(folder, {.width = 8, .height = 6, .fx = 6, .fy = 6, .cx = 3.5, .cy = 2.5});
  writer.write_events(events);
  writer.write_groundtruth(std::vector<StampedPose>{{0, Rigid3()}, {1, Rigid3()}});
  (void)writer.finish(DatasetRecord());
  LabelsH5Writer file(folder / "labels.h5");
  file.append(labels);
  file.close();
  return events;
}

// One in a hundred is dropped, all others come 5 us late, and of one in a thousand the polarity is
// flipped: each number follows by counting.
TEST_F(EvaluateEvents, KnownEditsOfALabelledDatasetAreMeasuredExactly) {
  const fs::path truth = folder_.path() / "truth";
  const Events events = write_labelled_dataset(truth);
  Events edited;
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (i % 100 == 7) continue;
    Event event = events[i];
    event.t_ns += 5'000;
    if (i % 1000 == 500) event.polarity = static_cast<std::int8_t>(-event.polarity);
    edited.push_back(event);
  }
  ASSERT_EQ(edited.size(), 99'000U);
  const fs::path found = write_events(folder_.path() / "found.h5", edited);
  evaluate_events({found, truth, {}}, folder_.path() / "scores");
  const Metrics scores = read_json_metrics(folder_.path() / "scores" / "metrics.json");
  EXPECT_DOUBLE_EQ(*scores.get("events.ratio"), 0.99);
  EXPECT_EQ(scores.get("events.precision_1us"), 0);
  EXPECT_EQ(scores.get("events.recall_1us"), 0);
  for (const char* within : {"10us", "100us"}) {
    EXPECT_DOUBLE_EQ(*scores.get(std::string("events.precision_") + within), 98'900.0 / 99'000);
    EXPECT_DOUBLE_EQ(*scores.get(std::string("events.recall_") + within), 0.989);
  }
  const auto count = [&](const Events& stream, int polarity) {
    return static_cast<double>(std::count_if(stream.begin(), stream.end(), [&](const Event& event) {
      return event.polarity == polarity;
    }));
  };
  for (const auto& [name, polarity] : {std::pair{"on", 1}, {"off", -1}})
    EXPECT_DOUBLE_EQ(*scores.get(std::string("events.") + name + ".ratio"),
                     count(edited, polarity) / count(events, polarity));
  // The dropped and the flipped ones are of the signal, of which there are 90,000.
  EXPECT_DOUBLE_EQ(*scores.get("events.origin.signal.recall_10us"), 88'900.0 / 90'000);
  EXPECT_EQ(scores.get("events.origin.shot.recall_10us"), 1);
  EXPECT_DOUBLE_EQ(*scores.get("events.median_dt_us"), 5);
  EXPECT_DOUBLE_EQ(*scores.get("events.median_signed_dt_us"), 5);
  EXPECT_DOUBLE_EQ(*scores.get("events.p99_dt_us"), 5);
  // The other way round precision and recall change places, and the labels are those of the first.
  const Metrics reversed = evaluate_events({truth, found, {}});
  EXPECT_DOUBLE_EQ(*reversed.get("events.recall_10us"), 98'900.0 / 99'000);
  EXPECT_DOUBLE_EQ(*reversed.get("events.origin.signal.precision_10us"), 88'900.0 / 90'000);
  EXPECT_DOUBLE_EQ(*reversed.get("events.median_signed_dt_us"), -5);
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
