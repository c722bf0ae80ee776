#include "eval/sweep/result/dataset_information.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/command.h"
#include "tests/support/fake_run.h"

namespace saccade {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Half a percent is the most that odometry may not know.
constexpr Information kEnough{0.01, 0.01, 0.2, 0.2, 0.3};
constexpr Information kTooLittle{0.01, 0.01, 2, 0.2, 0.3};

SweepRow row_of(const SweepJob& job, const Information& information) {
  SweepRow row{&job, false, {}, {}, {}};
  row.information = information;
  row.method_class = MethodClass{{MethodInput::kEvents, MethodInput::kStart}};
  return row;
}

TEST(TooLittle, IsWhatTheGivenInputsLeaveOpen) {
  SweepJob job;
  job.point.module = "odometry";
  EXPECT_EQ(has_enough(row_of(job, kEnough)), true);
  SweepRow row = row_of(job, kTooLittle);
  EXPECT_EQ(has_enough(row), false);
  row.method_class->inputs.erase(MethodInput::kStart);
  EXPECT_EQ(has_enough(row), true) << "the path from events alone is known";
  row.information.reset();
  EXPECT_EQ(has_enough(row), std::nullopt);
}

TEST(TooLittle, IsListedWithWhatBecameOfIt) {
  SweepJob quiet, honest, fine;
  quiet.dataset = "data/world-1", honest.dataset = "data/world-2", fine.dataset = "data/world-3";
  for (SweepJob* job : {&quiet, &honest, &fine}) job->point.module = "odometry";
  const SweepConfig sweep;
  const SweepPlan plan;
  SweepResults results{sweep, plan, {}, {}, {}};
  results.rows = {row_of(quiet, kTooLittle), row_of(honest, kTooLittle), row_of(fine, kEnough)};
  results.rows[0].metrics.set("success", 0.0);
  results.rows[0].metrics.set("trajectory.loss.unreported_s", 0.4);
  results.rows[1].metrics.set("success", 0.0);
  results.rows[1].metrics.set("trajectory.reported_lost_s", 0.3);
  const std::string page = too_little_section(results);
  EXPECT_THAT(page, HasSubstr("2 of the datasets tell too little"));
  EXPECT_THAT(page, HasSubstr("world-1"));
  EXPECT_THAT(page, HasSubstr("**wrong for 0.400 s, and does not say so**"));
  EXPECT_THAT(page, HasSubstr("says that it is lost for 0.300 s"));
  EXPECT_THAT(page, Not(HasSubstr("world-3")));
  results.rows.erase(results.rows.begin(), results.rows.begin() + 2);
  EXPECT_EQ(too_little_section(results), "");
}

TEST(DatasetInformation, IsKeptForAsLongAsTheDatasetIsTheSame) {
  const testing::TemporaryFolder folder;
  SweepPlan plan;
  plan.simulations.resize(1);
  plan.simulations[0].name = "corner";
  plan.simulations[0].output = folder.path() / "corner";
  testing::write_corner_dataset(folder.path() / "corner", "corner", 0.25, 80);
  const DatasetInformation found = dataset_information(plan, folder.path());
  ASSERT_EQ(found.size(), 1U);
  const double bound = found.begin()->second.path_percent;
  EXPECT_GT(bound, 0);
  // What is kept is taken as it is ...
  const std::string kept = testing::read_file(folder.path() / "information.csv");
  std::string changed = kept;
  const std::size_t at = changed.rfind(',');
  changed.replace(at + 1, changed.size() - at - 2, "0.125");
  (void)folder.write("information.csv", changed);
  EXPECT_EQ(dataset_information(plan, folder.path()).begin()->second.depth_share, 0.125);
  // ... but not of another dataset, nor from a file that cannot be read.
  testing::write_corner_dataset(folder.path() / "corner", "corner", 0.2, 80);
  EXPECT_NE(dataset_information(plan, folder.path()).begin()->second.depth_share, 0.125);
  (void)folder.write("information.csv", "no,table\n1\n");
  EXPECT_EQ(dataset_information(plan, folder.path()).size(), 1U);
}

}  // namespace
}  // namespace saccade
