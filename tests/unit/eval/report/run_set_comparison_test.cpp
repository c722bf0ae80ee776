#include "eval/report/run_set_comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace saccade {
namespace {

RunData scored_run(const std::string& sequence, std::uint64_t seed, double error,
                   const std::string& configuration, const std::string& version) {
  RunData run;
  run.dataset = sequence;
  run.method = "track " + configuration;
  run.run.folder = sequence + std::to_string(seed);
  RunRecord& record = run.run.record;
  record.module = "track";
  record.dataset = "data/" + sequence;
  record.seed = seed;
  record.command = "saccade run track -c " + configuration + ".yaml";
  record.tool_version = version;
  run.metrics.set("trajectory.dt_rel_percent.mean", error);
  return run;
}

/// Eight seeds on two sequences.
std::vector<RunData> side(double factor, const std::string& configuration,
                          const std::string& version) {
  std::vector<RunData> runs;
  for (std::uint64_t seed = 1; seed <= 8; ++seed)
    for (const char* sequence : {"walls", "desk"})
      runs.push_back(scored_run(sequence, seed, factor * (1 + 0.01 * static_cast<double>(seed)),
                                configuration, version));
  return runs;
}

const GateRow* row_of_scope(const RunSetComparison& comparison, const std::string& scope) {
  for (const GateRow& row : comparison.result.rows)
    if (row.scope == scope) return &row;
  return nullptr;
}

TEST(RunSetComparison, AreVersionsOfOneConfiguration) {
  const std::vector<RunData> before = side(1, "best", "0.9"), after = side(1.1, "best", "1.0");
  const RunSetComparison comparison = compare_run_sets(before, after);
  EXPECT_EQ(comparison.a, "0.9");
  EXPECT_EQ(comparison.b, "1.0");
  EXPECT_EQ(comparison.pairs.size(), 16U);
  EXPECT_EQ(comparison.pairs.front().scope, "walls, track best");
  const GateRow* row = row_of_scope(comparison, "track, 2 sequences");
  ASSERT_NE(row, nullptr);
  EXPECT_EQ(row->verdict, GateRow::Verdict::kRegressed);
  EXPECT_NEAR(row->change.value(), 0.1, 1e-3);
  EXPECT_LE(row->low.value(), row->change.value());
}

TEST(RunSetComparison, AreConfigurationsWhereNoTwoAreTheSame) {
  const std::vector<RunData> before = side(1, "fast", "1.0"), after = side(0.5, "best", "1.0");
  const RunSetComparison comparison = compare_run_sets(before, after);
  EXPECT_EQ(comparison.a, "track fast");
  EXPECT_EQ(comparison.b, "track best");
  EXPECT_EQ(comparison.pairs.front().scope, "walls, track");
  ASSERT_NE(row_of_scope(comparison, "walls, track"), nullptr);
  EXPECT_EQ(row_of_scope(comparison, "walls, track")->verdict, GateRow::Verdict::kImproved);
}

TEST(RunSetComparison, WithoutPartnerAreNoted) {
  const std::vector<RunData> before = side(1, "best", "1.0");
  std::vector<RunData> after = side(1, "best", "1.0");
  after.push_back(scored_run("office", 1, 1, "best", "1.0"));
  const RunSetComparison comparison = compare_run_sets(before, after);
  EXPECT_EQ(comparison.a, "before");
  EXPECT_EQ(comparison.pairs.size(), 16U);
  ASSERT_EQ(comparison.result.notes.size(), 1U);
  EXPECT_THAT(comparison.result.notes[0], ::testing::HasSubstr("office, track best, seed 1"));
}

TEST(RunSetComparison, RefuseWhatCannotBePaired) {
  const std::vector<RunData> walls{scored_run("walls", 1, 1, "best", "1.0")};
  const std::vector<RunData> desk{scored_run("desk", 1, 1, "best", "1.0")};
  EXPECT_THROW((void)compare_run_sets(walls, desk), InputError);
  const std::vector<RunData> twice{walls[0], walls[0]};
  EXPECT_THROW((void)compare_run_sets(twice, walls), InputError);
}

}  // namespace
}  // namespace saccade
