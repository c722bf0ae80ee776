#include "eval/store/result_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <limits>

#include "tests/support/error_of.h"
#include "tests/unit/eval/store/stored_runs.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using testing::error_of;
using ::testing::HasSubstr;
using testing::kDrift;
using testing::one_metric;
using ::testing::StartsWith;
using testing::TemporaryFolder;
using testing::write_stored_run;

/// All rows with what is measured of all their metrics.
std::vector<ResultRow> all_rows(const fs::path& store) {
  ResultReader reader(store);
  std::vector<ResultRow> rows = reader.select("", true);
  const MetricTable table = reader.metrics(rows, reader.metric_names());
  for (std::size_t row = 0; row < rows.size(); ++row)
    for (std::size_t i = 0; i < table.names().size(); ++i)
      if (!std::isnan(table.at(row, i))) rows[row].metrics.set(table.names()[i], table.at(row, i));
  return rows;
}

TEST(ReadResult, TakesWhatARunFolderStates) {
  const TemporaryFolder folder;
  const ResultRow row =
      read_result(write_stored_run(folder.path(),
                                   {.name = "a", .seed = 7, .metrics = one_metric(kDrift, 0.5)}) /
                  "");
  EXPECT_EQ(row.run, "a");
  EXPECT_EQ(row.module, "track");
  EXPECT_EQ(row.dataset, "walls");
  EXPECT_EQ(row.config, "best align.samples=50");
  EXPECT_EQ(row.seed, 7U);
  EXPECT_EQ(row.version, "0.1.0");
  EXPECT_EQ(row.commit, "aaaa11112222");
  EXPECT_EQ(row.end_s, 2);
  EXPECT_EQ(row.config_yaml, "align:\n  samples: 50\n");
  EXPECT_EQ(row.config_sha256.size(), 64U);
  EXPECT_EQ(row.run_sha256.size(), 64U);
  EXPECT_THAT(row.added, ::testing::MatchesRegex("....-..-..T..:..:..Z"));
  EXPECT_EQ(row.metrics.get(kDrift), 0.5);
}

TEST(ReadResult, ARunWithoutScoresHasItsSpeed) {
  const TemporaryFolder folder;
  const fs::path run = write_stored_run(folder.path(), {.name = "a"});
  folder.write("a/timing.json", R"({"wall_s": {"median": 2.5}, "repetitions": 1})");
  EXPECT_EQ(read_result(run).metrics.get("speed.wall_s.median"), 2.5);
}

TEST(ReadResult, MalformedFilesAreErrorsWithTheirPlace) {
  const TemporaryFolder folder;
  EXPECT_THAT(error_of([&] { return read_result(folder.path()); }), HasSubstr("is no run"));
  const fs::path run = write_stored_run(folder.path(), {.name = "a"});
  folder.write("a/metrics.json", "{\"x\": ");
  EXPECT_THAT(error_of([&] { return read_result(run); }), HasSubstr("a/metrics.json: byte"));
}

TEST(ResultStore, KeepsEveryColumnAndMetric) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / kResultStoreName;
  ResultRow row = read_result(write_stored_run(folder.path(), {.name = "a b'c"}));
  row.seed = std::numeric_limits<std::uint64_t>::max();
  row.start_s.reset();
  row.metrics.set(kDrift, 0.1);
  row.metrics.set("depth.rel_mean", std::nullopt);
  ResultStore(file).add({&row, 1});
  const std::vector<ResultRow> rows = all_rows(file);
  ASSERT_EQ(rows.size(), 1U);
  for (const ResultColumn& column : result_columns())
    std::visit([&](auto member) { EXPECT_EQ(rows[0].*member, row.*member) << column.name; },
               column.member);
  EXPECT_EQ(rows[0].metrics, one_metric(kDrift, 0.1));
  EXPECT_THAT(ResultReader(file).metric_names(), ElementsAre("depth.rel_mean", kDrift));
}

TEST(ResultStore, ScoringARunAgainReplacesItsRow) {
  const TemporaryFolder folder;
  Metrics metrics = one_metric(kDrift, 0.5);
  metrics.set("old", 1);
  const fs::path run = write_stored_run(folder.path(), {.name = "a", .metrics = metrics});
  store_result(write_stored_run(folder.path(), {.name = "b", .metrics = metrics}));
  store_result(run);
  write_stored_run(folder.path(), {.name = "a", .seed = 2, .metrics = one_metric(kDrift, 0.25)});
  store_result(run / "");
  const std::vector<ResultRow> rows = all_rows(folder.path() / kResultStoreName);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].run, "b");
  EXPECT_EQ(rows[0].metrics, metrics);
  EXPECT_EQ(rows[1].seed, 2U);
  EXPECT_EQ(rows[1].metrics, one_metric(kDrift, 0.25));
}

TEST(ResultStore, LoadsOnlyTheMetricsThatAreNamed) {
  const TemporaryFolder folder;
  Metrics metrics = one_metric(kDrift, 0.5);
  metrics.set("speed.wall_s.median", 3);
  store_result(write_stored_run(folder.path(), {.name = "a", .metrics = metrics}));
  ResultReader reader(folder.path() / kResultStoreName);
  EXPECT_THAT(reader.metric_names(), ElementsAre("speed.wall_s.median", kDrift));
  EXPECT_EQ(reader.stored_metric("speed.wall_s"), "speed.wall_s.median");
  const std::vector<ResultRow> rows = reader.select("");
  EXPECT_TRUE(rows[0].config_yaml.empty());
  const MetricTable table = reader.metrics(rows, {"speed.wall_s.median"});
  EXPECT_THAT(table.names(), ElementsAre("speed.wall_s.median"));
  EXPECT_EQ(table.at(0, 0), 3);
  EXPECT_TRUE(table.any_has(0));
}

TEST(ResultStore, SeveralProcessesWriteAtOnce) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / kResultStoreName;
  const ResultRow model = read_result(
      write_stored_run(folder.path(), {.name = "a", .metrics = one_metric(kDrift, 0.5)}));
  constexpr int kProcesses = 4;
  constexpr int kRows = 12;
  std::vector<pid_t> children;
  for (int process = 0; process < kProcesses; ++process) {
    children.push_back(fork());
    if (children.back() != 0) continue;
    try {
      for (int i = 0; i < kRows; ++i) {
        ResultRow row = model;
        row.run = std::to_string(process) + "_" + std::to_string(i);
        ResultStore(file).add({&row, 1});
      }
    } catch (const std::exception&) {
      _exit(1);
    }
    _exit(0);
  }
  for (const pid_t child : children) {
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
  }
  EXPECT_EQ(all_rows(file).size(), static_cast<std::size_t>(kProcesses * kRows));
}

TEST(ResultStore, WhatFailsHalfWayLeavesNothing) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / kResultStoreName;
  ResultStore store(file);
  {
    Database database(file, Database::Access::kWrite);
    const Transaction transaction(database);
    database.run("INSERT INTO runs (run) VALUES ('half')");
  }
  EXPECT_TRUE(all_rows(file).empty());
}

TEST(ResultStore, OtherFilesAreLeftAlone) {
  const TemporaryFolder folder;
  const fs::path text = folder.write("text", std::string(2000, 'x'));
  EXPECT_THAT(error_of([&] { return ResultReader(text).metric_names(); }),
              AllOf(StartsWith(text.string()), HasSubstr("not a database")));
  EXPECT_THAT(error_of([&] {
                ResultStore store(text);
                return 0;
              }),
              HasSubstr("not a database"));
  const fs::path other = folder.path() / "other.sqlite";
  Database(other, Database::Access::kWrite).run("CREATE TABLE mine (x)");
  EXPECT_THAT(error_of([&] {
                ResultStore store(other);
                return 0;
              }),
              HasSubstr("is no result store"));
  Database(other, Database::Access::kWrite).run("PRAGMA user_version = 9");
  EXPECT_THAT(error_of([&] { return ResultReader(other).metric_names(); }),
              HasSubstr("is a result store of version 9; this program knows version 1"));
  EXPECT_THAT(error_of([&] { return ResultReader(folder.path() / "none").metric_names(); }),
              HasSubstr("saccade results --scan"));
}

TEST(ResultStore, IsNoRunAmongThoseBesideIt) {
  const TemporaryFolder folder;
  const fs::path run = write_stored_run(folder.path(), {.name = "a"});
  store_result(run);
  const fs::path store = folder.path() / kResultStoreName;
  const fs::path called_so = folder.path() / "more" / kResultStoreName;
  fs::create_directories(called_so);
  EXPECT_EQ(without_store(std::vector{run, store, called_so}), (std::vector{run, called_so}));
  EXPECT_TRUE(without_store(std::vector{store}).empty());
}

TEST(Database, AReaderChangesNothing) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / kResultStoreName;
  store_result(write_stored_run(folder.path(), {.name = "a"}));
  Database reader(file, Database::Access::kRead);
  SqlFault fault;
  for (const char* sql : {"DELETE FROM runs", "DROP TABLE runs", "ATTACH 'x.sqlite' AS x",
                          "PRAGMA journal_mode = WAL", "VACUUM INTO 'x.sqlite'"})
    EXPECT_ANY_THROW(reader.run(sql)) << sql;
  EXPECT_EQ(all_rows(file).size(), 1U);
}

}  // namespace
}  // namespace saccade
