#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/verbs.h"
#include "core/error.h"
#include "core/io/run/run_record.h"
#include "tests/support/command.h"

namespace saccade {
namespace {

using ::testing::HasSubstr;
using testing::read_file;
using testing::TemporaryFolder;

/// Calls `saccade gate`; what it throws passes through.
void gate(std::vector<std::string> arguments) {
  CLI::App command;
  add_gate_verb(command);
  arguments.insert(arguments.begin(), {"gate"});
  arguments.insert(arguments.begin() + 1, "-q");
  std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
  command.parse(reversed);
}

std::string write_run(const TemporaryFolder& folder, const std::string& name, std::uint64_t seed,
                      const std::string& error) {
  folder.write(name + "/metrics.json",
               "{\"trajectory\": {\"dt_rel_percent\": {\"mean\": " + error + "}}}");
  RunRecord record;
  record.module = "track";
  record.dataset = "/data/walls";
  record.seed = seed;
  write_run_record(folder.path() / name / "run.yaml", record);
  return (folder.path() / name).string();
}

TEST(GateVerb, TripsAndPassesAgainAfterAnUpdate) {
  const TemporaryFolder folder;
  const std::string base = (folder.path() / "base.yaml").string();
  const std::string old = write_run(folder, "old", 1, "0.2");
  const std::string worse = write_run(folder, "new", 1, "0.4");
  EXPECT_THROW(gate({old, "--baseline", base}), InputError);  // not there yet
  gate({old, "--baseline", base, "--update"});
  gate({old, "--baseline", base});
  EXPECT_THROW(gate({worse, "--baseline", base}), std::runtime_error);
  gate({worse, "--baseline", base, "--gross", "1.5"});
  gate({worse, "--baseline", base, "--update"});
  gate({worse, "--baseline", base});
}

TEST(GateVerb, APartialUpdateKeepsTheOtherRuns) {
  const TemporaryFolder folder;
  const std::string base = (folder.path() / "base.yaml").string();
  const std::string first = write_run(folder, "first", 1, "0.2");
  const std::string second = write_run(folder, "second", 2, "0.3");
  gate({first, second, "--baseline", base, "--update"});
  gate({write_run(folder, "again", 2, "0.5"), "--baseline", base, "--update", "--partial"});
  EXPECT_THAT(read_file(base), HasSubstr("mean: 0.2\n"));
  EXPECT_THAT(read_file(base), HasSubstr("mean: 0.5\n"));
  gate({first, "--baseline", base, "--update"});
  EXPECT_THAT(read_file(base), ::testing::Not(HasSubstr("mean: 0.5\n")));
}

TEST(GateVerb, WritesItsReports) {
  const TemporaryFolder folder;
  const std::string base = (folder.path() / "base.yaml").string();
  gate({write_run(folder, "old", 1, "0.2"), "--baseline", base, "--update"});
  EXPECT_THROW(gate({write_run(folder, "new", 1, "null"), "--baseline", base, "--junit",
                     (folder.path() / "gate.xml").string(), "--markdown",
                     (folder.path() / "gate.md").string()}),
               std::runtime_error);
  EXPECT_THAT(read_file(folder.path() / "gate.xml"), HasSubstr("failures=\"1\""));
  EXPECT_THAT(read_file(folder.path() / "gate.md"), HasSubstr("| missing |"));
}

TEST(GateVerb, BadUseIsAnInputError) {
  EXPECT_THROW(gate({"run"}), InputError);
  EXPECT_THROW(gate({"--baseline", "base.yaml"}), InputError);
  EXPECT_THROW(gate({"run", "--baseline", "b.yaml", "--confidence", "1"}), InputError);
  EXPECT_THROW(gate({"--build", "/bin/true", "--", "run"}), InputError);
  EXPECT_THROW(gate({"--build", "/bin/true", "--build", "/bin/true"}), InputError);
  EXPECT_THROW(gate({"--build", "/not/there", "--build", "/bin/true", "--", "run"}), InputError);
}

TEST(GateVerb, RunsTwoBuildsInTurn) {
  const TemporaryFolder folder;
  const std::string log = (folder.path() / "log").string();
  gate({"--build", "/bin/sh", "--build", "/bin/sh", "--repeats", "2", "--slower", "100", "--", "-c",
        "echo x >> " + log});
  EXPECT_EQ(read_file(log), "x\nx\nx\nx\nx\nx\n");
}

}  // namespace
}  // namespace saccade
