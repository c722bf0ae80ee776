#include "eval/store/mlflow.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/config/config.h"
#include "tests/support/error_of.h"
#include "tests/unit/eval/store/stored_runs.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::kDrift;
using testing::one_metric;
using testing::read_file;
using testing::TemporaryFolder;
using testing::write_stored_run;

constexpr const char* kExperiment = "530871943702615348";

class Mlflow : public ::testing::Test {
 protected:
  /// A store of a scored run and one without scores; the folders of the runs that were written.
  std::vector<fs::path> written(std::string_view where = "") {
    const fs::path scored = write_stored_run(
        folder_.path(), {.name = "it's a run", .metrics = one_metric(kDrift, 0.5)});
    store_result(scored);
    store_result(write_stored_run(folder_.path(), {.name = "b", .seed = 2}));
    ResultReader reader(result_store_beside(scored));
    runs_ = write_mlflow(reader, where, out());
    std::vector<fs::path> folders;
    for (const fs::directory_entry& entry : fs::directory_iterator(out() / kExperiment))
      if (entry.is_directory()) folders.push_back(entry.path());
    return folders;
  }
  [[nodiscard]] fs::path out() const { return folder_.path() / "mlruns"; }

  TemporaryFolder folder_;
  std::size_t runs_ = 0;
};

TEST_F(Mlflow, WritesParamsMetricsTagsAndTheConfiguration) {
  const std::vector<fs::path> folders = written("seed = 1");
  EXPECT_EQ(runs_, 1U);
  ASSERT_EQ(folders.size(), 1U);
  const fs::path& run = folders[0];
  EXPECT_EQ(run.filename().string().size(), 32U);
  EXPECT_EQ(read_file(run / "params" / "dataset"), "walls");
  EXPECT_EQ(read_file(run / "params" / "seed"), "1");
  EXPECT_THAT(read_file(run / "metrics" / kDrift), ::testing::MatchesRegex("[0-9]+ 0\\.5 0\n"));
  EXPECT_EQ(read_file(run / "tags" / "mlflow.runName"), "it's a run");
  EXPECT_EQ(read_file(run / "tags" / "mlflow.source.git.commit"), "aaaa11112222");
  EXPECT_EQ(read_file(run / "artifacts" / "config.yaml"), "align:\n  samples: 50\n");
  const config::Document meta = config::load(run / "meta.yaml");
  EXPECT_THAT(read_file(run / "meta.yaml"), HasSubstr("run_name: 'it''s a run'\n"));
  EXPECT_THAT(read_file(run / "meta.yaml"), HasSubstr("run_id: " + run.filename().string()));
  EXPECT_THAT(read_file(out() / kExperiment / "meta.yaml"), HasSubstr("name: saccade\n"));
}

TEST_F(Mlflow, ARunThatIsWrittenAgainReplacesItself) {
  EXPECT_EQ(written().size(), 2U);
  fs::create_directories(out() / "2");
  EXPECT_EQ(written().size(), 2U);
  EXPECT_TRUE(fs::exists(out() / "2")) << "other experiments stay";
}

TEST_F(Mlflow, WhatWasNotMeasuredIsNotThere) {
  const std::vector<fs::path> folders = written("seed = 2");
  ASSERT_EQ(folders.size(), 1U);
  EXPECT_FALSE(fs::exists(folders[0] / "metrics" / kDrift));
}

}  // namespace
}  // namespace saccade
