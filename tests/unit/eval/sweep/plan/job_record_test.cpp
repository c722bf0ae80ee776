#include "eval/sweep/plan/job_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/eval/sweep/sweep_files.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

/// A job that is done, as far as its files tell.
class Resuming : public ::testing::Test {
 protected:
  Resuming() {
    folder_.write("scene/walls.obj", "o walls\n");
    folder_.write("scene/walls.mtl", "Kd 1 1 1\n");
    folder_.write("base.yaml", "scene: {meshes: [{file: scene/walls.obj}]}\n");
    simulation_.name = "walls";
    simulation_.config = folder_.write("walls.yaml", "include: base.yaml\nseed: 1\n");
    simulation_.output = folder_.path() / "data/walls";
    simulation_.settings = "simulate --seed 3";
    folder_.write("data/walls/dataset.yaml", "width: 8\n");
    run_.name = "walls_fast";
    run_.config = folder_.write("fast.yaml", "align: {samples: 50}\n");
    run_.dataset = simulation_.output;
    run_.output = folder_.path() / "runs/walls_fast";
    run_.settings = "run track";
    run_.scores = run_.output / "metrics.json";
    run_.makes_run = true;
    folder_.write("runs/walls_fast/run.yaml", "module: track\n");
    folder_.write("runs/walls_fast/metrics.json", "{}\n");
    for (const SweepJob* job : {&simulation_, &run_})
      write_job_record(record(*job), *job, JobInputs().of(*job), 1.5);
  }

  [[nodiscard]] fs::path record(const SweepJob& job) const {
    return folder_.path() / "jobs" / job.name / "job.yaml";
  }
  [[nodiscard]] std::string why(const SweepJob& job) const {
    return why_to_run(job, record(job), JobInputs().of(job));
  }

  TemporaryFolder folder_;
  SweepJob simulation_;
  SweepJob run_;
};

TEST_F(Resuming, WhatIsDoneIsSkipped) {
  EXPECT_EQ(why(simulation_), "");
  EXPECT_EQ(why(run_), "");
}

TEST_F(Resuming, ARunDependsOnTheRunThatItStartsFrom) {
  SweepJob refined = run_;
  refined.source_runs = {folder_.path() / "source"};
  EXPECT_THAT(why(refined), ::testing::HasSubstr("the run source"));
  const std::string before = identity_of(JobInputs().of(refined));
  folder_.write("source/run.yaml", "module: odometry\n");
  EXPECT_NE(identity_of(JobInputs().of(refined)), before);
}

TEST_F(Resuming, WhatIsNotDoneRuns) {
  SweepJob other = run_;
  other.name = "other";
  EXPECT_EQ(why(other), "not done yet");
}

TEST_F(Resuming, AnotherConfigurationRunsAgain) {
  folder_.write("fast.yaml", "align: {samples: 51}\n");
  EXPECT_THAT(why(run_), HasSubstr("fast.yaml differs"));
  EXPECT_EQ(why(simulation_), "");
}

TEST_F(Resuming, AnotherIncludeSceneOrTextureSimulatesAgain) {
  const std::vector<std::pair<std::string, std::string>> changes{
      {"base.yaml", "scene: {meshes: [{file: scene/walls.obj}], background: 1}\n"},
      {"scene/walls.obj", "o others\n"},
      {"scene/walls.mtl", "Kd 0.5 0.5 0.5\n"}};
  for (const auto& [file, text] : changes) {
    SCOPED_TRACE(file);
    const std::string before = testing::read_file(folder_.path() / file);
    write_job_record(record(simulation_), simulation_, JobInputs().of(simulation_), 1);
    EXPECT_EQ(why(simulation_), "");
    folder_.write(file, text);
    EXPECT_THAT(why(simulation_), HasSubstr(file + " differs"));
    folder_.write(file, before);
  }
}

TEST_F(Resuming, OtherSettingsRunAgain) {
  run_.settings = "run track --set align.samples=3";
  EXPECT_EQ(why(run_), "the command differs");
}

TEST_F(Resuming, AnotherDatasetRunsAgain) {
  folder_.write("data/walls/dataset.yaml", "width: 9\n");
  EXPECT_EQ(why(simulation_), "its output was replaced");
  EXPECT_EQ(why(run_), "the dataset differs");
}

TEST_F(Resuming, ARecordingIsKnownByItsFiles) {
  folder_.write("plain/events.txt", "0.1 0 0 1\n");
  run_.dataset = folder_.path() / "plain";
  write_job_record(record(run_), run_, JobInputs().of(run_), 1);
  EXPECT_EQ(why(run_), "");
  folder_.write("plain/events.txt", "0.1 0 0 1\n0.2 0 0 1\n");
  EXPECT_EQ(why(run_), "the dataset differs");
}

TEST_F(Resuming, AMissingOutputRunsAgain) {
  fs::remove(run_.output / "metrics.json");
  EXPECT_EQ(why(run_), "its output is gone");
  fs::remove_all(simulation_.output);
  EXPECT_EQ(why(simulation_), "its output is gone");
}

TEST_F(Resuming, ADamagedRecordRunsAgain) {
  folder_.write("jobs/walls_fast/job.yaml", "inputs: {");
  EXPECT_EQ(why(run_), "its job.yaml is damaged");
}

}  // namespace
}  // namespace saccade
