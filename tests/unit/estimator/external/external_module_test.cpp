#include "estimator/external/external_module.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/io/dataset/dataset.h"
#include "core/io/events/event_file.h"
#include "core/io/run/run_record.h"
#include "core/io/trajectory_file.h"
#include "core/process/progress.h"
#include "tests/support/error_of.h"
#include "tests/support/fake_run.h"
#include "tests/support/shared_folder.h"
#include "tests/unit/estimator/run_request.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using testing::error_of;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::read_file;
using ::testing::StartsWith;

/// A small dataset, over which shell scripts are the estimators.
class External : public testing::SharedFolder<External> {
 public:
  static void fill() { testing::write_corner_dataset(path("data"), "corner", 0.2, 60); }

 protected:
  /// Runs `sh -c SCRIPT`; what run.yaml says.
  [[nodiscard]] RunRecord run(const std::string& script, const std::string& more = "") const {
    return run_command("sh -c \"" + script + "\"", more);
  }
  [[nodiscard]] RunRecord run_command(const std::string& command, const std::string& more) const {
    set_progress_quiet(true);
    fs::remove_all(output());
    const RunRequest request =
        testing::run_request(path("data"), output(), "command: " + command + "\n" + more);
    static_cast<void>(run_external(request));
    return read_run_record(output() / "run.yaml");
  }
  [[nodiscard]] static fs::path output() { return path("run"); }
};

TEST_F(External, TakesThePosesOfAProgram) {
  const RunRecord record =
      run("printf '0.1 1 2 3 0 0 0 1\\\\n0.2 1 2 4 0 0 0 1\\\\n' > {out}/trajectory.txt; "
          "echo said",
          "name: a script\nversion_command: echo v7\n");
  ASSERT_TRUE(record.external);
  EXPECT_EQ(record.module, "external");
  EXPECT_EQ(record.external->name, "a script");
  EXPECT_EQ(record.external->version, "v7");
  EXPECT_EQ(record.external->status, "ok");
  EXPECT_EQ(record.problem(), "");
  const Trajectory poses = read_tum_trajectory(output() / "trajectory.txt");
  EXPECT_EQ(poses.size(), 2U);
  EXPECT_THAT(read_file(output() / "log.txt"), AllOf(StartsWith("$ sh -c"), HasSubstr("said")));
  EXPECT_THAT(read_file(output() / "timing.json"),
              AllOf(HasSubstr("\"cpu_s\""), HasSubstr("\"poses\": 2"), HasSubstr("peak_memory")));
  EXPECT_FALSE(fs::exists(output() / "input"));
}

TEST_F(External, HandsOverTheStartOfTheTruthAndScoresWhatFollows) {
  const RunRecord record =
      run("cp {groundtruth_start} {out}/trajectory.txt; ls {input} > {out}/listing; "
          "head -n 1 {events} > {out}/event; cp {calib} {out}",
          "start: {truth_s: 0.05}\ninput: {events: csv}\n");
  const Trajectory truth = Dataset::open(path("data")).groundtruth();
  const Trajectory start = read_tum_trajectory(output() / "trajectory.txt");
  EXPECT_LT(start.size(), truth.size() / 2);
  EXPECT_NEAR(start.end_s(), 0.05, 0.01);
  ASSERT_TRUE(record.window);
  EXPECT_EQ(record.window->start_s, start.end_s());
  EXPECT_EQ(read_file(output() / "output/listing"),
            "calib.txt\ncamera.yaml\nevents.csv\ngroundtruth.txt\n");
  EXPECT_EQ(read_file(output() / "output/event"), "t_us,x,y,p\n");
}

TEST_F(External, WhatGoesWrongIsAStatusWithoutPoses) {
  const auto problem = [&](const std::string& script, const std::string& more = "") {
    const std::string text = run(script, more).problem();
    EXPECT_EQ(read_file(output() / "trajectory.txt"), "");
    return text;
  };
  EXPECT_EQ(problem("echo one; echo two; exit 3"), "crashed: exit code 3; log: one / two");
  EXPECT_THAT(problem("kill -SEGV $$"), StartsWith("crashed: killed by signal 11"));
  EXPECT_EQ(problem("sleep 60", "timeout_s: 0.1\n"), "timed out: after 0.1 s");
  EXPECT_EQ(problem("true"),
            "bad output: trajectory.txt: was not written, which output.trajectory.file promises");
  EXPECT_THAT(problem("echo 0.1 nan 0 0 0 0 0 1 > {out}/trajectory.txt"),
              AllOf(StartsWith("bad output: trajectory.txt:1"), HasSubstr("finite")));
  EXPECT_THAT(problem("printf '0.2 0 0 0 0 0 0 1\\\\n0.1 0 0 0 0 0 0 1' > {out}/trajectory.txt"),
              HasSubstr("times must increase"));
}

TEST_F(External, ASimulatorLeavesEvents) {
  const RunRecord record = run("printf '0.001 3 4 1\\\\n0.002 5 6 0\\\\n' > {out}/made.txt",
                               "output: {events: made.txt}\n");
  EXPECT_EQ(record.problem(), "");
  const Events events = read_events(output() / "events.h5", {});
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[1], (Event{2'000'000, 5, 6, -1}));
  EXPECT_FALSE(fs::exists(output() / "trajectory.txt"));
  EXPECT_THAT(read_file(output() / "timing.json"), Not(HasSubstr("\"poses\"")));

  EXPECT_THAT(
      run("printf '0.001 60 4 1\\\\n' > {out}/made.txt", "output: {events: made.txt}\n").problem(),
      StartsWith("bad output: made.txt"))
      << "beyond the sensor of 60 x 45 pixels";
  EXPECT_EQ(run("exit 3", "output: {events: made.txt}\n").problem(), "crashed: exit code 3");
  EXPECT_TRUE(read_events(output() / "events.h5", {}).empty());
}

TEST_F(External, TheClassIsWhatTheAdapterStates) {
  const auto class_of = [&](const std::string& more) {
    return run("touch {out}/trajectory.txt", more).method_class;
  };
  EXPECT_EQ(class_of(""), std::nullopt) << "nobody knows";
  EXPECT_EQ(class_of("class: {inputs: [events, start], processing: batch}\n"),
            (MethodClass{{MethodInput::kEvents, MethodInput::kStart}, Processing::kBatch}));
  const auto error = [&](const std::string& yaml) {
    const RunRequest request = testing::run_request(path("data"), path("none"), yaml);
    return error_of([&] { return run_external(request).poses; });
  };
  EXPECT_THAT(error("{command: ls, start: {truth_s: 0.1}, class: {inputs: [events]}}"),
              HasSubstr("must hold `start`"));
  EXPECT_THAT(error("{command: 'ls {imu}', class: {inputs: [events]}}"),
              HasSubstr("must hold `imu`"));
  EXPECT_THAT(error("{command: 'ls {events}', class: {inputs: [imu]}}"),
              HasSubstr("must hold `events`"));
  EXPECT_THAT(error("{command: ls, class: {inputs: []}}"), HasSubstr("class.inputs"));
  EXPECT_THAT(error("{command: ls, output: {events: made.txt, map: map.ply}}"),
              HasSubstr("'map' and 'views' belong to a trajectory"));
}

TEST_F(External, WhatCannotBeginIsAnError) {
  const auto error = [&](const std::string& yaml) {
    const RunRequest request = testing::run_request(path("data"), path("none"), yaml);
    return error_of([&] { return run_external(request).poses; });
  };
  EXPECT_THAT(error("command: no_such_program {events}"), HasSubstr("cannot be started"));
  EXPECT_THAT(error("{}"), HasSubstr("command"));
  EXPECT_THAT(error("{command: ls, files: {a: nowhere.py}}"), HasSubstr("nowhere.py"));
  EXPECT_THAT(error("{command: ls, version_command: 'false'}"), HasSubstr("version_command"));
  EXPECT_FALSE(fs::exists(path("none")));
}

TEST_F(External, AProgramGetsItsEnvironmentByEnv) {
  const RunRecord record = run_command("env SEED={seed} sh -c 'echo $SEED; exit 1'", "seed: 7\n");
  EXPECT_EQ(record.problem(), "crashed: exit code 1; log: 7");
}

}  // namespace
}  // namespace saccade
