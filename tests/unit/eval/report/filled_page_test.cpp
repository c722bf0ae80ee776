#include "eval/report/filled_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "eval/table/number_text.h"
#include "tests/support/error_of.h"
#include "tests/unit/eval/store/stored_runs.h"

namespace saccade {
namespace {

using ::testing::AllOf;
using testing::error_of;
using ::testing::HasSubstr;
using testing::kDrift;
using testing::one_metric;
using testing::TemporaryFolder;
using testing::write_stored_run;

class FilledPage : public ::testing::Test {
 protected:
  FilledPage() {
    add("walls_fast_seed-1", one_metric(kDrift, 1));
    add("walls_fast_seed-2", one_metric(kDrift, 2));
    add("walls_best", one_metric("depth.rel_median", 0.0123));
    for (const double wall_s : {1.0, 2.0, 30.0})
      add("timed_" + std::to_string(static_cast<int>(wall_s)),
          one_metric("speed.poses_per_s.median", 1000 * wall_s));
  }

  [[nodiscard]] std::string fill(const std::string& text,
                                 const std::optional<std::string>& missing = {}) const {
    ResultReader reader(folder_.path() / kResultStoreName);
    return fill_page(text, "page.md", reader, missing);
  }
  [[nodiscard]] std::string error(const std::string& text) const {
    return error_of([&] { return fill(text); });
  }

  void add(const std::string& name, const Metrics& metrics) {
    store_result(write_stored_run(folder_.path(), {.name = name, .metrics = metrics}));
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(FilledPage, TextWithoutMarksStaysAsItIs) {
  EXPECT_EQ(fill("a {b} c\n|d|\n"), "a {b} c\n|d|\n");
  EXPECT_EQ(fill(""), "");
}

TEST_F(FilledPage, NamesOfRunsMayHaveStars) {
  EXPECT_EQ(fill("x {{walls_fast_seed-1 trajectory.drift_percent}} y\n"), "x 1.00 y\n");
  EXPECT_EQ(fill("{{walls_fast_* trajectory.drift_percent 1}}"), "1.5");
  EXPECT_EQ(fill("{{*fast*2 trajectory.drift_percent 0}}"), "2");
}

TEST_F(FilledPage, NumbersHaveTheScaleOfTheCatalogue) {
  EXPECT_EQ(fill("{{walls_best depth.rel_median 2}} %"), "1.23 %");
}

TEST_F(FilledPage, ASpeedIsTheMedianOfItsMedians) {
  EXPECT_EQ(fill("{{timed_* speed.poses_per_s}}"), "2,000");
}

TEST_F(FilledPage, WhatWasNotMeasuredIsADash) {
  EXPECT_EQ(fill("{{walls_best trajectory.drift_percent 1}}"), fixed(std::nullopt, 1));
}

TEST_F(FilledPage, ALostTrajectoryHasNoError) {
  Metrics lost = one_metric(kDrift, 5000);
  lost.set("trajectory.loss.first_s", 0.1);
  lost.set("depth.rel_median", 0.02);
  add("bad_1", lost);
  EXPECT_EQ(fill("{{bad_1 trajectory.drift_percent 1}}"), "lost");
  EXPECT_EQ(fill("{{bad_1 depth.rel_median 1}}"), "2.0");
  add("bad_2", one_metric(kDrift, 1));
  EXPECT_EQ(fill("{{bad_* trajectory.drift_percent 1}}"), "1 of 2 lost");
  EXPECT_EQ(fill("{{bad_2 trajectory.drift_percent 1}}"), "1.0");
}

TEST_F(FilledPage, ARunThatIsNotStoredHasWhatStandsForIt) {
  EXPECT_EQ(fill("{{dunes_* depth.rel_median}} {{walls_best depth.rel_median 2}}", "no run"),
            "no run 1.23");
}
TEST_F(FilledPage, MistakesNameTheirLineAndTheNearestAnswer) {
  EXPECT_THAT(error("\n\n{{walls_bost depth.rel_median}}"),
              AllOf(HasSubstr("page.md:3"), HasSubstr("'walls_best'")));
  EXPECT_THAT(error("{{walls_best depth.rel_medain}}"),
              AllOf(HasSubstr("page.md:1"), HasSubstr("'depth.rel_median'")));
  EXPECT_THAT(error("{{walls_best}}"), HasSubstr("{{RUNS METRIC}}"));
  EXPECT_THAT(error("{{walls_best depth.rel_median 9}}"), HasSubstr("0 to 6"));
  EXPECT_THAT(error("a {{walls_best"), HasSubstr("no '}}'"));
}

}  // namespace
}  // namespace saccade
