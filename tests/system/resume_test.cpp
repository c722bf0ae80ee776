// A simulation that is killed goes on where it was, to the same bytes; a full disk leaves nothing.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <string>
#include <thread>
#include <vector>

#include "core/io/dataset/dataset_record.h"
#include "tests/system/saccade_command.h"

namespace saccade::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::vector<std::string> simulation(const fs::path& data,
                                    const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments{
      "simulate",  shipped_config("simulation/walls.yaml"),
      "-o",        data.string(),
      "--set",     "duration_s=0.4",
      "--set",     "camera={width: 120, height: 90, fx: 100, fy: 100, cx: 59.5, cy: 44.5}",
      "--set",     "groundtruth.flow_rate_hz=20",
      "--set",     "groundtruth.event_labels=true",
      "--threads", "2"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

/// A run of the command that goes on beside the test.
class Background {
 public:
  /// `prepare` runs in the new process.
  explicit Background(
      const std::vector<std::string>& arguments, const std::function<void()>& prepare = [] {}) {
    std::vector<char*> argv{const_cast<char*>(SACCADE_COMMAND)};
    for (const std::string& argument : arguments)
      argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    child_ = fork();
    if (child_ != 0) return;
    std::freopen("/dev/null", "w", stderr);
    std::freopen("/dev/null", "w", stdout);
    prepare();
    execv(SACCADE_COMMAND, argv.data());
    _exit(127);
  }
  ~Background() { kill(); }
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  [[nodiscard]] bool is_running() {
    if (child_ > 0 && waitpid(child_, &status_, WNOHANG) == child_) child_ = 0;
    return child_ > 0;
  }
  void kill() {
    if (!is_running()) return;
    ::kill(child_, SIGKILL);
    waitpid(child_, &status_, 0);
    child_ = 0;
  }
  [[nodiscard]] bool was_killed() const { return WIFSIGNALED(status_); }
  /// Waits for its end.
  [[nodiscard]] int exit_code() {
    if (child_ > 0) waitpid(child_, &status_, 0);
    child_ = 0;
    return WIFEXITED(status_) ? WEXITSTATUS(status_) : -1;
  }

 private:
  pid_t child_ = -1;
  int status_ = 0;
};

/// Complete files below `folder`, 0 when it is not there.
std::size_t files_in(const fs::path& folder) {
  std::error_code error;
  std::size_t count = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    count += entry.path().filename().string().starts_with('.') ? 0 : 1;
  return count;
}

std::size_t images_in(const fs::path& dataset) {
  return files_in(dataset / "images") + files_in(dataset / "depth") + files_in(dataset / "flow");
}

/// How far an unfinished simulation is, in [0, 1]: images are the first part, events the rest.
class ProgressMeter {
 public:
  explicit ProgressMeter(const fs::path& complete)
      : images_(static_cast<double>(images_in(complete))) {
    const auto counts = *read_dataset_record(complete / "dataset.yaml").counts;
    journal_bytes_ = 16.0 * static_cast<double>(counts.events_on + counts.events_off);
  }

  [[nodiscard]] double of(const fs::path& data) const {
    constexpr double kImages = 0.2;
    const fs::path workplace =
        data.parent_path() / ("." + data.filename().string() + ".unfinished");
    const auto images = static_cast<double>(images_in(workplace / "content"));
    std::error_code error;
    const auto size = fs::file_size(workplace / "journal/cam0/events.journal", error);
    const double events = error ? 0 : static_cast<double>(size) / journal_bytes_;
    return kImages * std::min(1.0, images / images_) + (1 - kImages) * std::min(1.0, events);
  }

 private:
  double images_;
  double journal_bytes_;
};

/// The simulation of all tests without any interruption, and a place for others of the same name.
class Resume : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new TemporaryFolder;
    saccade_ok(simulation(reference()));
    meter_ = new ProgressMeter(reference());
  }
  static void TearDownTestSuite() {
    delete meter_;
    delete shared_;
  }

  static fs::path reference() { return shared_->path() / "walls"; }
  [[nodiscard]] fs::path data() const { return folder_.path() / "walls"; }

  /// Starts a simulation and kills it when `is_time`. Returns how far it came. A machine too busy
  /// to be in time tries again.
  double kill_when(const std::function<bool()>& is_time) const {
    for (int attempt = 0; attempt < 10; ++attempt) {
      Background run(simulation(data()));
      while (run.is_running() && !is_time())
        std::this_thread::sleep_for(std::chrono::microseconds(500));
      const double reached = meter_->of(data());
      run.kill();
      if (run.was_killed()) return reached;
      fs::remove_all(data());
    }
    ADD_FAILURE() << "the simulation was always over before it could be killed";
    return 0;
  }

  /// The same at a share of the whole progress.
  double kill_at(double target) const {
    return kill_when([&] { return meter_->of(data()) >= target; });
  }

  [[nodiscard]] fs::path unfinished() const { return folder_.path() / ".walls.unfinished"; }

  void expect_the_same() const {
    EXPECT_EQ(hash_files(data()), hash_files(reference()));
    EXPECT_EQ(read_file(data() / "dataset.yaml"), read_file(reference() / "dataset.yaml"));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()), 1);
  }

  static TemporaryFolder* shared_;
  static ProgressMeter* meter_;
  TemporaryFolder folder_;
};

TemporaryFolder* Resume::shared_ = nullptr;
ProgressMeter* Resume::meter_ = nullptr;

/// The line of `output` with `text`, or nothing.
std::string line_with(const std::string& output, const std::string& text) {
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);)
    if (line.find(text) != std::string::npos) return line;
  return {};
}

TEST_F(Resume, TwentyKillsLeadToTheSameBytes) {
  constexpr int kKills = 20;
  for (int i = 0; i < kKills; ++i) {
    const double target = 0.05 + 0.9 * i / (kKills - 1);
    const double reached = kill_at(target);
    EXPECT_FALSE(fs::exists(data()));
    const std::string output = saccade_ok(simulation(data()));
    const std::string line = line_with(output, "resuming at");
    EXPECT_NE(line, "") << output;
    std::cout << fmt::format("kill {:2} at {:5.1f} % of the progress: {}", i + 1, 100 * reached,
                             line.substr(line.rfind(": ") + 2))
              << std::endl;  // flushed: the next fork would inherit it
    expect_the_same();
    fs::remove_all(data());
  }
}

TEST_F(Resume, SeveralKillsOfOneSimulation) {
  for (const double target : {0.1, 0.3, 0.5, 0.7, 0.9}) kill_at(target);
  EXPECT_THAT(saccade_ok(simulation(data())), HasSubstr("resuming at"));
  expect_the_same();
}

TEST_F(Resume, ARigGoesOnWithTheCameraItWasAt) {
  const std::vector<std::string> pair{
      "--set", "rig=[{T_camera0_camera: [[1,0,0,0.1],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}]", "--set",
      "duration_s=0.2"};
  const TemporaryFolder other;
  const fs::path uninterrupted = other.path() / "walls";
  saccade_ok(simulation(uninterrupted, pair));
  const fs::path content = unfinished() / "content";
  const std::vector<std::function<bool()>> moments{
      [&] { return files_in(content / "cam1/images") > 4; },
      [&] { return fs::exists(content / "cam1/dataset.yaml"); },
      [&] { return files_in(content / "images") > 4; },
      [&] { return fs::exists(unfinished() / "journal/cam0/checkpoint"); }};
  for (const auto& is_time : moments) {
    Background run(simulation(data(), pair));
    while (run.is_running() && !is_time())
      std::this_thread::sleep_for(std::chrono::microseconds(500));
  }
  saccade_ok(simulation(data(), pair));
  EXPECT_EQ(hash_files(data()), hash_files(uninterrupted));
  EXPECT_EQ(read_file(data() / "dataset.yaml"), read_file(uninterrupted / "dataset.yaml"));
  EXPECT_THAT(saccade_ok({"info", data().string(), "--verify"}), HasSubstr("all files match"));
  EXPECT_THAT(saccade_ok({"info", (data() / "cam1").string(), "--verify"}),
              HasSubstr("all files match"));
}

TEST_F(Resume, ADatasetOfTheCacheGoesOnWhereItWas) {
  const OwnCache cache;
  const auto unfinished_images = [&] {
    std::error_code error;
    for (const fs::directory_entry& entry :
         fs::directory_iterator(cache.path() / "datasets", error))
      return files_in(entry.path() / ".walls.unfinished/content/images");
    return std::size_t{0};
  };
  {
    Background run(simulation(data(), {"--cached"}));
    while (run.is_running() && unfinished_images() <= 4)
      std::this_thread::sleep_for(std::chrono::microseconds(500));
    run.kill();
    ASSERT_TRUE(run.was_killed());
  }
  EXPECT_FALSE(fs::exists(data()));
  EXPECT_THAT(saccade_ok(simulation(data(), {"--cached"})), HasSubstr("resuming at"));
  EXPECT_EQ(hash_files(data()), hash_files(reference()));
  EXPECT_THAT(saccade_ok(simulation(data(), {"--cached"})), HasSubstr("simulated before"));
}

TEST_F(Resume, AnotherConfigurationStartsClean) {
  kill_at(0.5);
  const std::string output = saccade_ok(simulation(data(), {"--set", "imu.rate_hz=500"}));
  EXPECT_THAT(output, HasSubstr("starting clean instead of resuming: the configuration differs"));
  EXPECT_EQ(read_dataset_record(data() / "dataset.yaml").counts->imu_samples, 201);
  EXPECT_THAT(saccade_ok({"info", data().string(), "--verify"}), HasSubstr("all files match"));
}

TEST_F(Resume, DamagedLeftoversStartClean) {
  const fs::path log = unfinished() / "journal/cam0";
  kill_when([&] { return fs::exists(log / "checkpoint"); });
  std::fstream journal(log / "events.journal", std::ios::in | std::ios::out | std::ios::binary);
  journal.seekp(1000) << "damage";
  journal.close();
  const std::string output = saccade_ok(simulation(data()));
  EXPECT_THAT(output, HasSubstr("starting clean instead of resuming"));
  EXPECT_THAT(output, HasSubstr("events.journal: is damaged at byte"));
  expect_the_same();
}

TEST_F(Resume, AChangedInputFileStartsClean) {
  const fs::path poses =
      folder_.write("poses/poses.txt", "0 0 0.5 0 0 0 0 1\n1 0.1 0.5 0 0 0 0 1\n");
  const std::vector<std::string> more{"--set",
                                      "trajectory={source: file, file: " + poses.string() + "}"};
  {
    Background run(simulation(data(), more));
    while (run.is_running() && !fs::exists(unfinished() / "inputs.yaml"))
      std::this_thread::sleep_for(std::chrono::microseconds(500));
    run.kill();
    ASSERT_TRUE(run.was_killed());
  }
  folder_.write("poses/poses.txt", "0 0 0.5 0 0 0 0 1\n1 0.2 0.5 0 0 0 0 1\n");
  EXPECT_THAT(saccade_ok(simulation(data(), more)),
              HasSubstr("starting clean instead of resuming: " + poses.string() + " differs"));
}

TEST_F(Resume, ASecondWriterIsRefused) {
  Background first(simulation(data()));
  while (first.is_running() && meter_->of(data()) == 0)
    std::this_thread::sleep_for(std::chrono::microseconds(500));
  const CommandResult second = saccade(simulation(data()));
  if (second.exit_code != 0) {  // else the first one was over already
    EXPECT_EQ(second.exit_code, 2);
    EXPECT_THAT(second.output, HasSubstr("is being written by another program"));
  }
  EXPECT_EQ(first.exit_code(), 0);
  expect_the_same();
}

TEST_F(Resume, AFileThatCannotGrowEndsClean) {
  for (const rlim_t bytes : {rlim_t{2'000}, rlim_t{30'000}, rlim_t{500'000}}) {
    Background run(simulation(data()), [bytes] {
      std::signal(SIGXFSZ, SIG_IGN);
      const rlimit limit{bytes, bytes};
      setrlimit(RLIMIT_FSIZE, &limit);
    });
    EXPECT_EQ(run.exit_code(), 2);
    EXPECT_TRUE(fs::is_empty(folder_.path())) << *fs::directory_iterator(folder_.path());
  }
}

TEST_F(Resume, AFullDiskEndsClean) {
  const fs::path disk = folder_.path() / "disk";
  fs::create_directory(disk);
  std::uintmax_t needed = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(reference()))
    if (entry.is_regular_file()) needed += entry.file_size();
  for (const double share : {0.05, 0.4, 0.8, 1.0}) {
    const std::string size =
        fmt::format("size={}", static_cast<std::uintmax_t>(share * static_cast<double>(needed)));
    if (mount("none", disk.c_str(), "tmpfs", 0, size.c_str()) != 0)
      GTEST_SKIP() << "mounting a small disk is not permitted here";
    const CommandResult result = saccade(simulation(disk / "walls"));
    const bool is_empty = fs::is_empty(disk);
    umount(disk.c_str());
    EXPECT_EQ(result.exit_code, 2) << result.output;
    EXPECT_THAT(result.output, HasSubstr("cannot be written"));
    EXPECT_THAT(result.output, HasSubstr("make room"));
    EXPECT_TRUE(is_empty) << "with " << size;
    std::cout << fmt::format("disk of {:3.0f} %: {}", 100 * share,
                             line_with(result.output, "cannot be written"))
              << std::endl;
  }
}

}  // namespace
}  // namespace saccade::testing
