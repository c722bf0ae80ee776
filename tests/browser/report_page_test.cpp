#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "eval/report/report.h"
#include "eval/report/site/publish.h"
#include "tests/support/source_path.h"
#include "tests/unit/eval/fake_folders.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

bool is_installed(const std::string& program) {
  return std::system(("command -v " + program + " >/dev/null").c_str()) == 0;
}

class ReportPage : public testing::FakeFolders {};

TEST_F(ReportPage, OpensInChromium) {
  if (!is_installed("node") || !is_installed("chromium"))
    GTEST_SKIP() << "needs node and chromium, which ./dev install-deps installs";
  const fs::path page = path("report.html");
  // Several methods make a leaderboard, which the script sorts.
  std::vector<fs::path> runs{run()};
  for (const auto& [name, slow_m] : {std::pair("fast", 0.02), std::pair("best", 0.001)}) {
    testing::FakeErrors errors;
    errors.slow_m = slow_m;
    runs.push_back(path(std::string("walls_") + name));
    testing::write_fake_run(runs.back(), dataset(), errors, name);
  }
  write_report(runs, page);
  const std::string script = testing::source_path("tests/browser/report_page.mjs");
  EXPECT_EQ(std::system(("node '" + script + "' chromium '" + page.string() + "'").c_str()), 0);
}

TEST_F(ReportPage, ASiteIsSearchedAndFollowed) {
  if (!is_installed("node") || !is_installed("chromium"))
    GTEST_SKIP() << "needs node and chromium, which ./dev install-deps installs";
  const fs::path site = path("site");
  ReportOptions options;
  for (const auto& [title, slow_m] : {std::pair("First", 0.004), std::pair("Second", 0.006)}) {
    std::vector<fs::path> runs;
    for (const int seed : {1, 2, 3}) {
      testing::FakeErrors errors;
      errors.slow_m = slow_m * (1 + 0.1 * seed);
      runs.push_back(path("walls_" + std::string(title) + "_seed-" + std::to_string(seed)));
      testing::write_fake_run(runs.back(), dataset(), errors, "accurate");
    }
    runs.push_back(path("walls_best_of_" + std::string(title)));
    testing::write_fake_run(runs.back(), dataset(), {}, "best");
    options.title = title;
    publish_report(runs, site, options);
  }
  const std::string script = testing::source_path("tests/browser/site_page.mjs");
  EXPECT_EQ(std::system(("node '" + script + "' chromium '" + site.string() + "'").c_str()), 0);
}

}  // namespace
}  // namespace saccade
