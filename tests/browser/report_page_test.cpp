#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "eval/report/report.h"
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
  const std::vector<fs::path> runs{run()};
  write_report(runs, page);
  const std::string script = SACCADE_SOURCE_DIR "/tests/browser/report_page.mjs";
  EXPECT_EQ(std::system(("node '" + script + "' chromium '" + page.string() + "'").c_str()), 0);
}

}  // namespace
}  // namespace saccade
