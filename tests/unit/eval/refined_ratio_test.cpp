#include "eval/refined_ratio.h"

#include <gtest/gtest.h>

#include <array>
#include <fstream>

#include "core/error.h"
#include "eval/evaluate.h"
#include "eval/report/report.h"
#include "tests/unit/eval/fake_folders.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::TemporaryFolder;

TEST(RefinedRatios, AreQuotientsOfErrors) {
  Metrics scores, refined;
  scores.set("trajectory.dt_rel_percent.mean", 0.2);
  scores.set("trajectory.dtheta_deg.mean", 0.1);
  scores.set("trajectory.poses", 100);
  scores.set("depth.rel_median", 0.01);
  refined.set("trajectory.dt_rel_percent.mean", 0.05);
  refined.set("trajectory.dtheta_deg.mean", 0);
  refined.set("trajectory.poses", 50);
  const Metrics ratios = refined_ratios(scores, refined);
  EXPECT_EQ(ratios.values().size(), 2U);
  EXPECT_EQ(ratios.get("refined_ratio.trajectory.dt_rel_percent.mean"), 4);
  EXPECT_TRUE(ratios.values().contains("refined_ratio.trajectory.dtheta_deg.mean"));
  EXPECT_FALSE(ratios.get("refined_ratio.trajectory.dtheta_deg.mean"));
}

TEST(FindRefined, PrefersTheOneThatCameFromTheRun) {
  RunFolder run, other, own, depth;
  run.folder = "runs/a";
  run.record.module = "track";
  for (RunFolder* refined : {&other, &own, &depth}) refined->record.module = "refine";
  own.record.from = "runs/a";
  other.record.from = "runs/gone";
  for (RunFolder* folder : {&run, &other, &own, &depth}) folder->record.dataset = "data/walls";
  EXPECT_EQ(find_refined(run, std::array<const RunFolder*, 3>{&run, &other, &own}), &own);
  EXPECT_EQ(find_refined(run, std::array<const RunFolder*, 2>{&run, &depth}), nullptr);
  own.record.dataset = "data/planes";
  EXPECT_EQ(find_refined(run, std::array<const RunFolder*, 1>{&own}), nullptr);
}

/// A run of track and one of refine that was made from it, with half of its errors.
class RefinedRun : public testing::FakeFolders {
 protected:
  RefinedRun() {
    testing::write_fake_run(
        refined(), dataset(),
        {.slow_m = 0.002, .noise_m = 0.0004, .slow_deg = 0.1, .noise_deg = 0.02});
    std::string record = testing::read_file(refined() / "run.yaml");
    record.replace(record.find("module: track"), 13, "module: refine\nfrom: " + run().string());
    std::ofstream(refined() / "run.yaml") << record;
  }
  [[nodiscard]] fs::path refined() const { return folder_.path() / "refined"; }

  TemporaryFolder folder_;
};

TEST_F(RefinedRun, EvalComparesWithIt) {
  EvaluateOptions options;
  options.refined = refined();
  const Metrics metrics = evaluate_run(run(), options);
  EXPECT_NEAR(*metrics.get("refined_ratio.trajectory.dt_rel_percent.mean"), 2, 0.2);
  EXPECT_EQ(read_json_metrics(run() / "metrics.json"), metrics);
  EXPECT_NE(format_metrics(metrics, "walls").find("x refined optimum"), std::string::npos);
  options.refined = run();
  EXPECT_THROW((void)evaluate_run(run(), options), InputError);
}

TEST_F(RefinedRun, TheReportHasItsColumn) {
  const std::vector<fs::path> alone = {run()}, both = {run(), refined()};
  const fs::path page = folder_.path() / "report.html";
  (void)evaluate_run(run());  // another test may have left scores with the ratio
  write_report(alone, page);
  EXPECT_EQ(testing::read_file(page).find("refined optimum"), std::string::npos);
  write_report(both, page);
  EXPECT_NE(testing::read_file(page).find("× refined optimum"), std::string::npos);
}

}  // namespace
}  // namespace saccade
