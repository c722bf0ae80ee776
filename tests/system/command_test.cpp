// The command as such: its help, its configurations, its exit codes, what it leaves behind.

#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "core/io/dataset/dataset_record.h"
#include "core/random.h"
#include "tests/system/saccade_command.h"

namespace saccade::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::SizeIs;

/// The verbs that the help lists.
std::vector<std::string> verbs() {
  std::istringstream help(saccade_ok({"--help"}));
  std::vector<std::string> names;
  bool listed = false;
  for (std::string line; std::getline(help, line);) {
    if (listed && line.starts_with("  ") && line.size() > 2 && line[2] != ' ')
      names.push_back(line.substr(2, line.find(' ', 2) - 2));
    else if (line.starts_with("Subcommands"))
      listed = true;
    else
      listed = listed && line.starts_with("   ");
  }
  return names;
}

TEST(Command, EveryVerbExplainsItselfWithAnExample) {
  const std::vector<std::string> all = verbs();
  for (const char* verb : {"simulate", "run", "eval", "report", "gate", "sweep", "results", "cache",
                           "render", "info", "statistics", "calibrate", "convert"})
    EXPECT_THAT(all, Contains(verb));
  for (const std::string& verb : all)
    EXPECT_THAT(saccade_ok({verb, "--help"}),
                AllOf(HasSubstr("Example"), HasSubstr("saccade " + verb)));
  EXPECT_THAT(saccade_ok({"--help"}), AllOf(HasSubstr("Example"), HasSubstr("Exit codes")));
}

TEST(Command, StatesItsVersion) { EXPECT_TRUE(saccade_ok({"--version"}).starts_with("saccade ")); }

TEST(Command, WithoutAVerbIsBadUsage) {
  const CommandResult result = saccade({});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.output, HasSubstr("saccade --help"));
}

TEST(Command, MissingArgumentsAreBadUsage) {
  for (const std::string& verb : verbs()) {
    const CommandResult result = saccade({verb});
    EXPECT_EQ(result.exit_code, 2) << verb;
    EXPECT_FALSE(result.output.empty()) << verb;
  }
}

/// The call that prints a shipped configuration with everything resolved.
std::vector<std::string> print_call(const fs::path& config) {
  const std::string folder = config.parent_path().filename();
  if (folder == "simulation") return {"simulate", config.string(), "--print-config"};
  if (folder == "sweeps" || folder == "benchmark")
    return {"sweep", config.string(), "--print-config"};
  if (folder == "tracking") return {"run", "track", "-c", config.string(), "--print-config"};
  if (folder == "depth") return {"run", "depth", "-c", config.string(), "--print-config"};
  if (folder == "reconstruction")
    return {"run", "reconstruct", "-c", config.string(), "--print-config"};
  if (folder == "odometry") return {"run", "odometry", "-c", config.string(), "--print-config"};
  if (folder == "refinement") return {"run", "refine", "-c", config.string(), "--print-config"};
  if (folder == "rotation") return {"run", "rotation", "-c", config.string(), "--print-config"};
  if (folder == "stabilization")
    return {"run", "stabilize", "-c", config.string(), "--print-config"};
  if (folder == "mosaic") return {"run", "mosaic", "-c", config.string(), "--print-config"};
  ADD_FAILURE() << config << ": state here which verb reads the configurations of its folder";
  return {};
}

std::vector<fs::path> shipped_configs() {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(shipped_config("")))
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  return files;
}

TEST(Command, ReadsEveryShippedConfigurationAndPrintsItsFixedPoint) {
  const TemporaryFolder folder;
  ASSERT_THAT(shipped_configs(), SizeIs(::testing::Ge(6)));
  int read = 0;
  for (const fs::path& config : shipped_configs()) {
    SCOPED_TRACE(config);
    if (config.filename() == "walls_handheld.yaml" || config.filename() == "handheld_imu.yaml")
      continue;  // below
    if (config.parent_path().filename() == "catalogue")
      continue;  // its tests skip without packages
    if (saccade(print_call(config)).output.find("apt-get install") != std::string::npos)
      continue;  // its pictures are of a package that is not installed here
    const std::string printed = saccade_ok(print_call(config));
    const fs::path copy =
        folder.write(config.parent_path().filename() / config.filename(), printed);
    EXPECT_EQ(saccade_ok(print_call(copy)), printed);
    ++read;
  }
  EXPECT_GT(read, 60) << "too many were passed over";
}

TEST(Command, SaysThatTheRecordedMotionIsNotShipped) {
  const TemporaryFolder folder;
  const fs::path motion = folder.write("hand.csv", "# timestamp, x, y, z, qx, qy, qz, qw\n");
  for (const char* name : {"simulation/walls_handheld.yaml", "simulation/handheld_imu.yaml"}) {
    const std::string config = shipped_config(name);
    const CommandResult result = saccade({"simulate", config, "-o", folder.path() / "data"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.output, HasSubstr("poster_6dof_handheld.csv"));
    EXPECT_THAT(saccade_ok({"simulate", config, "--print-config", "--set",
                            "trajectory.file=" + motion.string()}),
                HasSubstr(motion.string()));
  }
}

/// `count` events with nanoseconds, in the text that the command writes itself; no two at one time,
/// because those are put in the order of their pixels.
std::string text_events(std::size_t count) {
  std::string text;
  const Random random(5);
  std::uint64_t t_ns = 999'990'000;
  for (std::size_t i = 0; i < count; ++i) {
    t_ns += 1 + random.below(3000, 0, i);
    text += fmt::format("{}.{:09} {} {} {}\n", t_ns / 1'000'000'000, t_ns % 1'000'000'000,
                        random.below(240, 1, i), random.below(180, 2, i), i % 2);
  }
  return text;
}

TEST(Command, ConvertsTextToHdf5AndBackWithoutLosingANanosecond) {
  const TemporaryFolder folder;
  const fs::path text = folder.write("events.txt", text_events(20'000));
  const std::string binary = folder.path() / "events.h5";
  const std::string back = folder.path() / "back.txt";
  saccade_ok({"convert", text.string(), binary});
  saccade_ok({"convert", binary, back});
  EXPECT_TRUE(read_file(text) == read_file(back));
  EXPECT_THAT(saccade_ok({"info", binary}), HasSubstr("20,000"));
  saccade_ok({"convert", text.string(), binary, "--unit", "us"});
  EXPECT_THAT(saccade_ok({"info", binary}), HasSubstr("stamps in us"));
}

TEST(Command, NamesADatasetAfterItsFolderHoweverThatIsWritten) {
  const TemporaryFolder folder;
  saccade_ok({"simulate", shipped_config("simulation/walls.yaml"), "-o",
              (folder.path() / "mine").string() + "/", "--set", "duration_s=0.02"});
  EXPECT_EQ(read_dataset_record(folder.path() / "mine" / "dataset.yaml").name, "mine");
}

/// Ends a simulation without warning as soon as its hidden folder holds something.
void kill_midway(const std::vector<std::string>& arguments, const fs::path& parent) {
  const pid_t child = fork();
  if (child == 0) {
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    std::vector<char*> argv = {const_cast<char*>(SACCADE_COMMAND)};
    for (const std::string& argument : arguments)
      argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    execv(SACCADE_COMMAND, argv.data());
    _exit(127);
  }
  int status = 0;
  while (fs::is_empty(parent) && waitpid(child, &status, WNOHANG) == 0)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  kill(child, SIGKILL);
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status)) << "it ended before it could be killed";
}

TEST(Command, AKilledSimulationLeavesNothingUnderItsName) {
  const TemporaryFolder folder;
  const fs::path data = folder.path() / "data";
  const std::string config = shipped_config("simulation/walls.yaml");
  kill_midway({"simulate", config, "-o", data.string(), "--set", "frames.rate_hz=500"},
              folder.path());
  EXPECT_FALSE(fs::exists(data));
  saccade_ok({"simulate", config, "-o", data.string(), "--set", "duration_s=0.02"});
  saccade_ok({"info", data.string(), "--verify"});
}

void expect_refused(const std::vector<std::string>& arguments, const fs::path& note) {
  const CommandResult result = saccade(arguments);
  EXPECT_EQ(result.exit_code, 2) << result.output;
  EXPECT_THAT(result.output, HasSubstr(note.parent_path().string()));
  EXPECT_EQ(read_file(note), "mine\n");
  EXPECT_EQ(std::distance(fs::directory_iterator(note.parent_path()), fs::directory_iterator()), 1);
}

TEST(Command, NeverReplacesAFolderThatItDidNotWrite) {
  const TemporaryFolder folder;
  const fs::path note = folder.write("thesis/notes.txt", "mine\n");
  const std::string thesis = note.parent_path();
  const std::string data = folder.path() / "data";
  const std::string config = shipped_config("simulation/walls.yaml");
  const std::vector<std::string> simulate = {"simulate", config, "--set", "duration_s=0.02", "-o"};
  const auto with = [](std::vector<std::string> arguments, const std::string& output) {
    arguments.push_back(output);
    return arguments;
  };
  expect_refused(with(simulate, thesis), note);
  saccade_ok(with(simulate, data));
  expect_refused({"run", "track", "--data", data, "-o", thesis}, note);
}

}  // namespace
}  // namespace saccade::testing
