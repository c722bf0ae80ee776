// Every verb with every call of the system that may fail: it succeeds, or says what is wrong and leaves nothing under the
// final name, and the next call succeeds with the same bytes. $SACCADE_FAULTS_EACH is how many calls of a kind are tried
// (default 6, spread over all; 0: all).

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/io/dataset/dataset_record.h"
#include "tests/system/saccade_command.h"

namespace saccade::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

using Words = std::vector<std::string>;

/// Environment variables that hold while it lives.
class Variables {
 public:
  explicit Variables(const std::vector<std::pair<std::string, std::string>>& values) {
    for (const auto& [name, value] : values) {
      names_.push_back(name);
      setenv(name.c_str(), value.c_str(), 1);
    }
  }
  ~Variables() {
    for (const std::string& name : names_) unsetenv(name.c_str());
  }
  Variables(const Variables&) = delete;
  Variables& operator=(const Variables&) = delete;

 private:
  std::vector<std::string> names_;
};

Words simulation(const fs::path& data) {
  return {"simulate",  shipped_config("simulation/walls.yaml"),
          "-o",        data.string(),
          "--set",     "duration_s=0.05",
          "--set",     "camera={width: 48, height: 36, fx: 40, fy: 40, cx: 23.5, cy: 17.5}",
          "--set",     "groundtruth.event_labels=true",
          "--threads", "1",
          "-q"};
}

/// What a call writes, and the call that writes it to `out`.
struct Call {
  std::string name;
  std::string output;  ///< name of the file or folder
  std::function<Words(const fs::path& inputs, const fs::path& out)> words;
  /// Whether all bytes are the same at every call; runs and pages state times.
  bool repeats = true;
};

Words track(const fs::path& inputs, const fs::path& out) {
  return {"run", "track",      "--data", (inputs / "d").string(),
          "-o",  out.string(), "-c",     shipped_config("tracking/fast.yaml"),
          "-q"};
}

const std::vector<Call>& calls() {
  static const std::vector<Call> all{
      {"simulate", "d", [](const fs::path&, const fs::path& out) { return simulation(out); }},
      {"run", "r", track, false},
      {"convert", "e.h5",
       [](const fs::path& inputs, const fs::path& out) {
         return Words{"convert", (inputs / "d/events.h5").string(), out.string(), "-q"};
       }},
      {"convert_text", "e.txt",
       [](const fs::path& inputs, const fs::path& out) {
         return Words{"convert", (inputs / "d/events.h5").string(), out.string(), "-q"};
       }},
      {"report", "r.html",
       [](const fs::path& inputs, const fs::path& out) {
         return Words{"report", (inputs / "r").string(), "-o", out.string(), "-q"};
       },
       false},
      {"render", "p.png",
       [](const fs::path& inputs, const fs::path& out) {
         return Words{"render", (inputs / "d").string(), "-o", out.string(), "-q"};
       }},
      {"gate_update", "b.yaml",
       [](const fs::path& inputs, const fs::path& out) {
         return Words{"gate", (inputs / "r").string(), "--baseline", out.string(), "--update"};
       }},
  };
  return all;
}

/// The inputs of all calls, made once.
class Faults : public ::testing::TestWithParam<std::size_t> {
 protected:
  static void SetUpTestSuite() {
    inputs_ = new TemporaryFolder;
    saccade_ok(simulation(inputs_->path() / "d"));
    saccade_ok(track(inputs_->path(), inputs_->path() / "r"));
    saccade_ok({"eval", (inputs_->path() / "r").string()});
  }
  static void TearDownTestSuite() { delete inputs_; }

  [[nodiscard]] static const Call& call() { return calls()[GetParam()]; }
  [[nodiscard]] fs::path out() const { return folder_.path() / call().output; }
  [[nodiscard]] Words words() const { return call().words(inputs_->path(), out()); }

  /// The hash of all that a call wrote.
  [[nodiscard]] static std::map<std::string, std::string> hashes(const fs::path& path) {
    if (fs::is_directory(path)) return hash_files(path);
    return {{"", read_file(path)}};
  }

  [[nodiscard]] std::vector<std::string> left_behind() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_.path()))
      names.push_back(entry.path().filename().string());
    return names;
  }
  void clear() const {
    for (const auto& entry : fs::directory_iterator(folder_.path())) fs::remove_all(entry.path());
  }

  [[nodiscard]] std::vector<std::pair<std::string, std::string>> fault_variables(
      const std::string& kind, long number) const {
    return {{"LD_PRELOAD", SACCADE_FAULT_LIBRARY},
            {"SACCADE_FAULT", fmt::format("{}:{}", kind, number)},
            {"SACCADE_FAULT_UNDER", folder_.path().string()},
            {"SACCADE_FAULT_COUNT", (counts_.path() / "count").string()}};
  }
  [[nodiscard]] CommandResult with_fault(const std::string& kind, long number) const {
    const Variables variables(fault_variables(kind, number));
    return saccade(words());
  }
  /// The call as a process that goes on beside this one; what it says of errors goes to `log`.
  [[nodiscard]] pid_t begin(const fs::path& log) const {
    const Words all = words();
    std::vector<char*> argv{const_cast<char*>(SACCADE_COMMAND)};
    for (const std::string& word : all) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    const pid_t child = fork();
    if (child == 0) {
      std::freopen(log.c_str(), "w", stderr);
      std::freopen("/dev/null", "w", stdout);
      execv(SACCADE_COMMAND, argv.data());
      _exit(127);
    }
    return child;
  }
  /// How many calls of the kind a call without faults makes.
  [[nodiscard]] long count(const std::string& kind) const {
    fs::remove(counts_.path() / "count");
    const CommandResult result = with_fault(kind, -1);
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return fs::exists(counts_.path() / "count") ? std::stol(read_file(counts_.path() / "count"))
                                                : 0;
  }

  /// Begins the call, holds it at its `place`-th call of the system, sends the signal and returns how it ended.
  [[nodiscard]] int end_at(long place, int signal, const fs::path& log) const {
    const fs::path count_file = counts_.path() / "count";
    fs::remove(count_file);
    const Variables variables(fault_variables("pause", place));
    const pid_t child = begin(log);
    int status = 0;
    pid_t ended = 0;
    const auto is_there = [&] {
      long calls = 0;
      std::ifstream(count_file) >> calls;
      return calls >= place;
    };
    while (ended == 0 && !is_there()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      ended = waitpid(child, &status, WNOHANG);
    }
    if (ended != 0) return status;
    ::kill(child, signal);
    waitpid(child, &status, 0);
    return status;
  }

  void expect_clean(const std::string& kind, long number) const {
    SCOPED_TRACE(fmt::format("{}, {} {}", call().name, kind, number));
    clear();
    const CommandResult result = with_fault(kind, number);
    if (result.exit_code == 0) {
      EXPECT_TRUE(fs::exists(out()));
      if (call().repeats) {
        EXPECT_EQ(hashes(out()), expected_);
      }
    } else {
      EXPECT_TRUE(result.exit_code == 1 || result.exit_code == 2) << result.exit_code;
      EXPECT_THAT(result.output, HasSubstr("saccade: "));
      EXPECT_FALSE(fs::exists(out())) << result.output;
      EXPECT_THAT(left_behind(), ::testing::IsEmpty()) << result.output;
      ++refused_;
    }
    saccade_ok(words());
    if (call().repeats) {
      EXPECT_EQ(hashes(out()), expected_);
    }
  }

  static TemporaryFolder* inputs_;
  TemporaryFolder folder_;
  TemporaryFolder counts_;
  std::map<std::string, std::string> expected_;
  mutable int refused_ = 0;
};

TemporaryFolder* Faults::inputs_ = nullptr;

/// Numbers from 1 to `count`, at most so many as the environment says, the first and the last among them.
std::set<long> chosen(long count) {
  const char* each = std::getenv("SACCADE_FAULTS_EACH");
  const long most = each == nullptr ? 6 : std::atol(each);
  std::set<long> numbers;
  if (most == 0 || count <= most)
    for (long i = 1; i <= count; ++i) numbers.insert(i);
  else
    for (long i = 0; i < most; ++i) numbers.insert(1 + i * (count - 1) / (most - 1));
  return numbers;
}

TEST_P(Faults, EndInSuccessOrInAnErrorThatLeavesNothing) {
  saccade_ok(words());
  expected_ = hashes(out());
  int tried = 0;
  for (const std::string kind : {"no-space", "io-error", "short-write", "interrupted", "create",
                                 "rename", "sync", "truncate"}) {
    clear();
    for (const long number : chosen(count(kind))) {
      expect_clean(kind, number);
      ++tried;
    }
  }
  // A file at least is created, written and renamed.
  EXPECT_GE(tried, 3);
  EXPECT_GT(refused_, 0) << "no fault was noticed at all";
  std::cout << fmt::format("{}: {} faults, {} of them ended in an error\n", call().name, tried,
                           refused_);
}

// A call that never returns holds the program where the signal shall meet it, however busy the machine is.
TEST_P(Faults, ASignalEndsItWithOneLineAndNothingTemporary) {
  saccade_ok(words());
  expected_ = hashes(out());
  clear();
  const long places = count("pause");
  ASSERT_GT(places, 0);
  int interrupted = 0;
  for (const auto& [signal, code] : {std::pair{SIGINT, 130}, std::pair{SIGTERM, 143}})
    for (const long place : chosen(places)) {
      SCOPED_TRACE(fmt::format("{} at place {} of {}", call().name, place, places));
      clear();
      const fs::path log = counts_.path() / "log";
      const int status = end_at(place, signal, log);
      ASSERT_TRUE(WIFEXITED(status));
      if (WEXITSTATUS(status) == code) {
        ++interrupted;
        EXPECT_THAT(read_file(log), HasSubstr("saccade: interrupted (SIG"));
        for (const std::string& name : left_behind())
          EXPECT_TRUE(name == call().output || name.ends_with(".unfinished")) << name;
      } else {
        // Threads make their calls in another order each time, so that the last place may not be reached.
        EXPECT_EQ(WEXITSTATUS(status), 0) << read_file(log);
      }
      saccade_ok(words());
      if (call().repeats) {
        EXPECT_EQ(hashes(out()), expected_);
      }
    }
  EXPECT_GT(interrupted, 0) << "it was always over before the signal came";
}

// A folder that loses a part while it is written must not stand there without what marks it as ours. Every file is renamed
// when it is complete, and then the folder, one that can be resumed twice: the last file is the marker, and the error names it.
TEST_P(Faults, TheMarkerOfAFolderIsWrittenLast) {
  const std::map<std::string, std::pair<std::string, long>> folders{
      {"simulate", {"dataset.yaml", 2}}, {"run", {"run.yaml", 1}}};
  const auto folder = folders.find(call().name);
  if (folder == folders.end()) GTEST_SKIP() << "writes a file";
  const auto& [marker, folder_renames] = folder->second;
  const long renames = count("rename");
  clear();
  const CommandResult result = with_fault("rename", renames - folder_renames);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.output, HasSubstr("/" + marker + ": "));
}

TEST_P(Faults, WhatItWritesMayBeTakenAwayMeanwhile) {
  saccade_ok(words());
  expected_ = hashes(out());
  int noticed = 0;
  for (const int after_ms : {0, 1, 2, 5, 10, 20, 40}) {
    SCOPED_TRACE(fmt::format("{} after {} ms", call().name, after_ms));
    clear();
    const fs::path log = counts_.path() / "log";
    const pid_t child = begin(log);
    int status = 0;
    pid_t ended = 0;
    while (left_behind().empty() && ended == 0) ended = waitpid(child, &status, WNOHANG);
    std::this_thread::sleep_for(std::chrono::milliseconds(after_ms));
    std::error_code ignored;
    for (const std::string& name : left_behind()) fs::remove_all(folder_.path() / name, ignored);
    if (ended == 0) waitpid(child, &status, 0);
    ASSERT_TRUE(WIFEXITED(status)) << read_file(log);
    if (WEXITSTATUS(status) != 0) {
      ++noticed;
      EXPECT_TRUE(WEXITSTATUS(status) == 1 || WEXITSTATUS(status) == 2) << WEXITSTATUS(status);
      EXPECT_THAT(read_file(log), HasSubstr("saccade: "));
      EXPECT_FALSE(fs::exists(out())) << read_file(log);
    } else if (fs::exists(out()) && call().repeats) {
      EXPECT_EQ(hashes(out()), expected_);
    }
    saccade_ok(words());
    if (call().repeats) {
      EXPECT_EQ(hashes(out()), expected_);
    }
  }
  std::cout << fmt::format("{}: taken away 7 times, {} ended in an error\n", call().name, noticed)
            << std::flush;
}

INSTANTIATE_TEST_SUITE_P(Calls, Faults, ::testing::Range(std::size_t{0}, calls().size()),
                         [](const auto& index) { return calls()[index.param].name; });

}  // namespace
}  // namespace saccade::testing
