#include "eval/sweep/result/ablation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/random.h"
#include "eval/table/table.h"
#include "tests/support/error_of.h"
#include "tests/unit/eval/sweep/sweep_files.h"

namespace saccade {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using testing::read_sweep;
using testing::TemporaryFolder;

constexpr const char* kError = "trajectory.dt_rel_percent.mean";

/// `full`, `worse` by 10 % and `same`, over `seeds` seeds that scatter by 3 %.
class Ablation : public ::testing::Test {
 protected:
  std::vector<Table> tables(int seeds, const std::string& reference = "full") {
    std::string list;
    for (int seed = 1; seed <= seeds; ++seed)
      list += (seed == 1 ? "" : ", ") + std::to_string(seed);
    sweep_ = read_sweep(folder_,
                        "datasets: [{path: recorded}]\nconfigurations: [{file: fast.yaml}]\n"
                        "variants: [{name: full}, {name: worse, set: {a.b: 1}}, "
                        "{name: same, set: {a.b: 2}}]\nreference: " +
                            reference + "\nseeds: [" + list + "]\n");
    plan_ = plan_sweep(sweep_, folder_.path() / "out");
    const Random random(7);
    for (std::size_t i = 0; i < plan_.runs.size(); ++i) {
      const SweepPoint& point = plan_.runs[i].point;
      SweepRow row{&plan_.runs[i], false, {}, "a machine", "0.1"};
      const double scatter = 1 + 0.03 * random.normal(0, i);
      row.metrics.set(kError, (point.variant == "worse" ? 0.33 : 0.3) * scatter);
      row.metrics.set("speed.wall_s.median", point.variant == "same" ? 2 : 1);
      results_.rows.push_back(row);
    }
    results_.groups = group_by_seed(results_.rows);
    results_.metrics = {kError};
    return ablation_tables(results_);
  }

  TemporaryFolder folder_;
  SweepConfig sweep_;
  SweepPlan plan_;
  SweepResults results_{sweep_, plan_, {}, {}, {}};
};

TEST_F(Ablation, MarksWhatDiffersBeyondChance) {
  const std::vector<Table> both = tables(12);
  ASSERT_EQ(both.size(), 2U);
  ASSERT_EQ(both[0].rows.size(), 3U);
  EXPECT_EQ(both[0].rows[0][0].text, "full");
  EXPECT_THAT(both[0].rows[1][1].text, HasSubstr("*"));
  EXPECT_THAT(both[0].rows[2][1].text, Not(HasSubstr("*")));
  EXPECT_EQ(both[0].rows[2][2].text, "2.00");
  // `full` and `same` do not differ: neither is the best.
  for (const auto& row : both[0].rows) EXPECT_FALSE(row[1].best) << row[0].text;
  ASSERT_EQ(both[1].rows.size(), 2U);
  EXPECT_EQ(both[1].rows[0][0].text, "worse");
  EXPECT_EQ(both[1].rows[0][2].text, "12");
  EXPECT_LT(both[1].rows[0][6].value->mean, -0.9);
  EXPECT_LT(both[1].rows[0][7].value->mean, 0.01);
  EXPECT_GT(both[1].rows[1][7].value->mean, 0.05);
}

TEST_F(Ablation, OfFewPairsNothingIsMarked) {
  const std::vector<Table> both = tables(5);
  for (const auto& row : both[0].rows) EXPECT_THAT(row[1].text, Not(HasSubstr("*")));
}

TEST_F(Ablation, TheBestIsBoldWhereItBeatsAllOthers) {
  static_cast<void>(tables(12));
  for (SweepRow& row : results_.rows)
    if (row.job->point.variant == "same") row.metrics.set(kError, *row.metrics.get(kError) / 2);
  const std::vector<Table> both = ablation_tables(results_);
  EXPECT_TRUE(both[0].rows[2][1].best);
  EXPECT_THAT(table_latex(both[0]), HasSubstr("\\textbf{0.1"));
}

TEST_F(Ablation, TheReferenceMustBeARow) {
  EXPECT_THAT(testing::error_of([&] { return tables(2, "ful"); }),
              HasSubstr("did you mean 'full'?"));
}

TEST(GridPlan, OneAtATimeVariesEachKeyAlone) {
  const TemporaryFolder folder;
  const SweepConfig sweep =
      read_sweep(folder,
                 "datasets: [{path: recorded}]\nconfigurations: [{file: fast.yaml}]\n"
                 "grid: {a: [1, 2, 3], b: [x, y]}\nplan: one_at_a_time\n");
  std::vector<std::vector<std::string>> points;
  for (const SweepJob& job : plan_sweep(sweep, folder.path() / "out").runs)
    points.push_back(job.point.grid);
  EXPECT_EQ(points, (std::vector<std::vector<std::string>>{
                        {"1", "x"}, {"2", "x"}, {"3", "x"}, {"1", "y"}}));
}

}  // namespace
}  // namespace saccade
