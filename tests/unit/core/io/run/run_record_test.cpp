#include "core/io/run/run_record.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/command.h"

namespace saccade {
namespace {

using testing::TemporaryFolder;

TEST(RunRecord, ReadsBackWhatItWrote) {
  RunRecord record;
  record.module = "track";
  record.dataset = "/data/walls";
  record.dataset_sha256 = "abc";
  record.window = RunRecord::Window{0.25, 1.5};
  record.method_class = MethodClass{{MethodInput::kMap, MethodInput::kEvents}, Processing::kBatch};
  record.seed = 18446744073709551615U;
  record.threads = 2;
  record.tool_version = "0.1.0 (123)";
  record.command = "saccade run track -o 'a b'";
  record.machine = "processor: fast, with \"quotes\"";
  record.config_yaml = "align:\n  samples: 500\n";
  TemporaryFolder folder;
  write_run_record(folder.path() / "run.yaml", record);
  const RunRecord read = read_run_record(folder.path() / "run.yaml");
  EXPECT_EQ(read.module, record.module);
  EXPECT_EQ(read.dataset, record.dataset);
  EXPECT_EQ(read.window->start_s, 0.25);
  EXPECT_EQ(read.window->end_s, 1.5);
  EXPECT_EQ(read.method_class, record.method_class);
  EXPECT_EQ(read.seed, record.seed);
  EXPECT_EQ(read.threads, 2);
  EXPECT_EQ(read.command, record.command);
  EXPECT_EQ(read.machine, record.machine);
  EXPECT_EQ(read.config_yaml, record.config_yaml);
}

TEST(RunRecord, NeedsOnlyModuleAndDataset) {
  TemporaryFolder folder;
  const RunRecord record = read_run_record(
      folder.write("run.yaml", "format_version: 1\nmodule: track\ndataset: {path: walls}\n"));
  EXPECT_EQ(record.dataset, folder.path() / "walls");
  EXPECT_FALSE(record.window);
  EXPECT_FALSE(record.method_class);
  EXPECT_TRUE(record.config_yaml.empty());
}

TEST(RunRecord, RefusesWhatItDoesNotKnow) {
  TemporaryFolder folder;
  const auto refuse = [&](const std::string& text) {
    EXPECT_THROW((void)read_run_record(folder.write("run.yaml", text)), InputError) << text;
  };
  refuse("format_version: 2\nmodule: track\ndataset: {path: walls}\n");
  refuse("format_version: 1\ndataset: {path: walls}\n");
  refuse("format_version: 1\nmodule: track\ndataset: {path: walls}\nclass: {inputs: [event]}\n");
  refuse(
      "format_version: 1\nmodule: track\ndataset: {path: walls}\nwindow: {start_s: 2, end_s: 1}\n");
}

TEST(MethodClass, IsNamedInAFixedOrder) {
  const MethodClass method{{MethodInput::kMap, MethodInput::kImu, MethodInput::kEvents},
                           Processing::kFixedLag};
  EXPECT_EQ(inputs_text(method), "events + IMU + map");
  EXPECT_EQ(processing_text(method), "fixed lag");
}

TEST(MethodClass, OfAResultThatContinuesAnotherHoldsTheInputsOfBoth) {
  const MethodClass tracked{{MethodInput::kEvents, MethodInput::kMap}};
  const MethodClass refined{{MethodInput::kEvents, MethodInput::kImu}, Processing::kBatch};
  const MethodClass both{{MethodInput::kEvents, MethodInput::kImu, MethodInput::kMap},
                         Processing::kBatch};
  EXPECT_EQ(merged(tracked, refined), both);
  EXPECT_EQ(merged(refined, tracked), both);
}

}  // namespace
}  // namespace saccade
