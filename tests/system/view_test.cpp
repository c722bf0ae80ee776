// `saccade view` as a server: its address, its token, what it refuses, how it ends; and the page that it serves in a real
// browser.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <httplib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/io/run/path_so_far.h"
#include "core/io/trajectory_file.h"
#include "tests/support/fake_run.h"
#include "tests/system/saccade_command.h"

namespace saccade::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;

/// A `saccade view` that is running, by what it printed first.
class Viewer {
 public:
  explicit Viewer(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {SACCADE_COMMAND, "view", "--no-browser"});
    std::array<int, 2> ends{};
    EXPECT_EQ(pipe(ends.data()), 0);
    child_ = fork();
    if (child_ == 0) {
      dup2(ends[1], STDOUT_FILENO);
      close(ends[0]);
      close(ends[1]);
      std::vector<char*> argv;
      for (std::string& argument : arguments) argv.push_back(argument.data());
      argv.push_back(nullptr);
      execv(argv[0], argv.data());
      _exit(127);
    }
    close(ends[1]);
    output_ = fdopen(ends[0], "r");
    url_ = next_line();
  }
  ~Viewer() {
    if (child_ > 0) end(SIGKILL);
    std::fclose(output_);
  }
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  [[nodiscard]] const std::string& url() const { return url_; }
  [[nodiscard]] int port() const { return std::stoi(url_.substr(url_.find(':', 6) + 1)); }
  [[nodiscard]] std::string page() const { return url_.substr(url_.find('/', 8)); }
  /// The next line that it prints; empty at the end.
  std::string next_line() {
    std::string line;
    for (int c = std::fgetc(output_); c != EOF && c != '\n'; c = std::fgetc(output_))
      line += static_cast<char>(c);
    return line;
  }
  /// Its exit code after a signal; -1: the signal killed it.
  int end(int signal) {
    kill(child_, signal);
    int status = 0;
    waitpid(child_, &status, 0);
    child_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t child_ = -1;
  FILE* output_ = nullptr;
  std::string url_;
};

class View : public ::testing::Test {
 protected:
  void SetUp() override {
    write_corner_dataset(path("walls"), "walls", 0.25, 80);
    write_fake_run(path("fast"), path("walls"));
    FakeErrors errors;
    errors.slow_m = 0.001;
    write_fake_run(path("best"), path("walls"), errors, "best");
    add_fake_keyframes(path("best"), 5);
  }
  [[nodiscard]] std::string path(const std::string& name) const { return folder_.path() / name; }

 private:
  TemporaryFolder folder_;
};

int status_of(httplib::Client& client, const std::string& target) {
  const httplib::Result answer = client.Get(target);
  return answer ? answer->status : -1;
}

TEST_F(View, ServesWhoHasTheTokenAndEndsWithOneLine) {
  Viewer viewer({path("fast"), path("best")});
  ASSERT_THAT(viewer.url(), MatchesRegex("http://127\\.0\\.0\\.1:[0-9]+/[0-9a-f]{32}/"));
  httplib::Client client("127.0.0.1", viewer.port());
  const httplib::Result page = client.Get(viewer.page());
  ASSERT_TRUE(page);
  EXPECT_EQ(page->status, 200);
  EXPECT_THAT(page->body, HasSubstr("<title>fast</title>"));
  EXPECT_EQ(page->get_header_value("X-Content-Type-Options"), "nosniff");
  const httplib::Result sources = client.Get(viewer.page() + "sources");
  ASSERT_TRUE(sources);
  EXPECT_EQ(nlohmann::json::parse(sources->body)["runs"].size(), 2U);
  const std::string wrong =
      std::string(viewer.page()).replace(1, 1, viewer.page()[1] == '0' ? "1" : "0");
  for (const std::string& target :
       {std::string("/"), std::string("/sources"), wrong, wrong + "sources",
        std::string("/favicon.ico"), "/../" + viewer.page(), "/?token=" + viewer.page()})
    EXPECT_EQ(status_of(client, target), 403) << target;
  EXPECT_EQ(status_of(client, viewer.page() + "../../../../etc/passwd"), 404);
  EXPECT_EQ(status_of(client, viewer.page() + "frame?recording=0&id=99999999999999999999"), 400);
  EXPECT_EQ(status_of(client, viewer.page() + std::string(7000, 'a')), 404);
  EXPECT_EQ(client.Post(viewer.page() + "sources", "x", "text/plain")->status, 405);
  EXPECT_EQ(status_of(client, viewer.page() + "sources"), 200) << "it goes on";
  EXPECT_EQ(viewer.end(SIGINT), 0);
  EXPECT_EQ(viewer.next_line(), "ended");
  EXPECT_EQ(viewer.next_line(), "");
}

TEST_F(View, TwoHaveOtherTokensAndNeverOnePort) {
  const Viewer first({path("walls")});
  EXPECT_NE(first.page(), Viewer({path("walls")}).page());
  const CommandResult second =
      saccade({"view", path("walls"), "--no-browser", "--port", std::to_string(first.port())});
  EXPECT_EQ(second.exit_code, 2);
  EXPECT_THAT(second.output, HasSubstr("--port: " + std::to_string(first.port()) + " is taken"));
}

TEST_F(View, TakesThePortThatItIsGiven) {
  int port = 0;
  {
    const Viewer free({path("walls")});
    port = free.port();
  }
  EXPECT_EQ(Viewer({path("walls"), "--port", std::to_string(port)}).port(), port);
}

TEST_F(View, BadInputIsNamed) {
  const TemporaryFolder empty;
  for (const auto& [arguments, problem] :
       std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{empty.path()}, "is neither a dataset nor a run"},
           {{path("none")}, "no such folder"},
           {{path("walls"), path("none")}, "no such folder"},
           {{path("walls") + "/events.h5"}, "is a file"},
           {{path("walls"), "--port", "70000"}, "--port"},
           {{path("walls"), "--port", "0"}, "--port"},
           {{path("walls"), "--prot", "80"}, "did you mean '--port'?"},
           {{path("walls"), "--export", path("x.html"), "--port", "8080"}, "--port"},
           {{}, "PATH"}}) {
    std::vector<std::string> words = arguments;
    words.insert(words.begin(), "view");
    const CommandResult result = saccade(words);
    EXPECT_EQ(result.exit_code, 2) << result.output;
    EXPECT_THAT(result.output, HasSubstr(problem));
  }
  EXPECT_FALSE(fs::exists(path("x.html")));
}

TEST_F(View, ServedAndExportedItIsAPageInChromium) {
  if (!on_search_path("node") || !on_search_path("chromium"))
    GTEST_SKIP() << "needs node and chromium, which ./dev install-deps installs";
  const auto passes = [](const std::string& url) {
    return std::system(
               ("node '" + source_path("tests/browser/view_page.mjs") + "' chromium '" + url + "'")
                   .c_str()) == 0;
  };
  const Viewer viewer({path("fast"), path("best")});
  EXPECT_TRUE(passes(viewer.url()));
  EXPECT_THAT(saccade_ok({"view", path("fast"), path("best"), "--export", path("clip.html")}),
              HasSubstr("all "));
  EXPECT_TRUE(passes("file://" + path("clip.html")));
}

TEST_F(View, ARunThatIsBeingWrittenIsFollowedInChromium) {
  if (!on_search_path("node") || !on_search_path("chromium"))
    GTEST_SKIP() << "needs node and chromium, which ./dev install-deps installs";
  const fs::path hidden = path(".growing.partial-1");
  fs::create_directories(hidden);
  const Trajectory truth = read_trajectory(path("walls") + "/groundtruth.txt");
  PathSoFar(hidden, path("walls")).show(truth.poses().first(3));
  const Viewer viewer({path("growing")});
  EXPECT_EQ(std::system(("node '" + source_path("tests/browser/live_page.mjs") + "' chromium '" +
                         viewer.url() + "' '" + hidden.string() + "'")
                            .c_str()),
            0);
}

}  // namespace
}  // namespace saccade::testing
