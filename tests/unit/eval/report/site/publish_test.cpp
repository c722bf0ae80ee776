#include "eval/report/site/publish.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "core/io/run/run_record.h"
#include "eval/report/site/published_report.h"
#include "eval/report/site/site_pages.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"
#include "tests/unit/eval/fake_folders.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::error_of;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::read_file;
using testing::TemporaryFolder;

/// The values of href and src that are no data and no place on the page itself.
std::vector<std::string> links_of(const std::string& page) {
  std::vector<std::string> links;
  for (const std::string mark : {"href=\"", "src=\""})
    for (std::size_t at = 0; (at = page.find(mark, at)) != std::string::npos;) {
      at += mark.size();
      const std::string link = page.substr(at, page.find('"', at) - at);
      if (!link.starts_with('#') && !link.starts_with("data:")) links.push_back(link);
    }
  return links;
}

class Publish : public testing::FakeFolders {
 protected:
  fs::path published(const std::vector<fs::path>& runs, const std::string& title) {
    ReportOptions options;
    options.title = title;
    return publish_report(runs, site(), options);
  }
  [[nodiscard]] fs::path site() const { return folder_.path() / "site"; }
  /// A run of another seed with other errors.
  fs::path another(const std::string& name, double slow_m) {
    testing::FakeErrors errors;
    errors.slow_m = slow_m;
    const fs::path made = folder_.path() / name;
    testing::write_fake_run(made, dataset(), errors);
    return made;
  }
  [[nodiscard]] std::vector<fs::path> pages() const {
    std::vector<fs::path> found;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(site()))
      if (entry.path().extension() == ".html") found.push_back(entry.path());
    return found;
  }

  TemporaryFolder folder_;
};

TEST_F(Publish, EveryLinkLeadsToAFileOfTheSite) {
  published({run(), another("walls_other", 0.01)}, "Two runs");
  EXPECT_EQ(pages().size(), 5U) << "index, method, report, two runs";
  for (const fs::path& page : pages()) {
    const std::string text = read_file(page);
    EXPECT_THAT(text, Not(HasSubstr("{{"))) << page;
    for (const std::string& link : links_of(text)) {
      const fs::path target = page.parent_path() / link.substr(0, link.find('#'));
      EXPECT_TRUE(fs::exists(target)) << page << " leads to " << link;
    }
  }
}

TEST_F(Publish, TheSameReportReplacesItselfAndNoOther) {
  const fs::path first = published({run()}, "Nightly: all");
  EXPECT_THAT(first.string(), HasSubstr("reports/nightly-all-"));
  EXPECT_EQ(published({run()}, "Nightly: all"), first);
  EXPECT_EQ(read_published_reports(site()).size(), 1U);
  EXPECT_NE(published({run()}, "Weekly"), first);
  EXPECT_NE(published({another("walls_other", 0.01)}, "Nightly: all"), first);
  EXPECT_EQ(read_published_reports(site()).size(), 3U);
  const std::string index = read_file(site() / "index.html");
  for (const char* text : {"Nightly: all", "Weekly", "track accurate"})
    EXPECT_THAT(index, HasSubstr(text));
  EXPECT_THAT(read_file(site() / "assets" / "runs.js"), HasSubstr("walls_other"));
}

TEST_F(Publish, AMethodsPageShowsItsScoresOverTheReports) {
  published({run()}, "First");
  published({another("walls_accurate_later", 0.02)}, "Second");
  const std::string page = read_file(site() / "methods" / "track-accurate.html");
  EXPECT_THAT(page, HasSubstr("data-chart=\"trend/0\""));
  EXPECT_THAT(page, HasSubstr(">First</a>"));
  EXPECT_THAT(page, HasSubstr(">Second</a>"));
}

/// Eleven reports with three seeds each, the last five a fifth worse.
TEST(MethodPage, NamesTheReportFromWhichOnAScoreIsWorse) {
  std::vector<PublishedReport> reports;
  for (int i = 0; i < 11; ++i) {
    PublishedReport report{"r" + std::to_string(i),
                           "Report " + std::to_string(i),
                           "2026-01-" + std::to_string(10 + i) + "T00:00:00Z",
                           "0.3.0",
                           {}};
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const double wobble =
          0.01 * static_cast<double>((static_cast<std::uint64_t>(i) * 7 + seed * 3) % 5);
      report.runs.push_back(
          {.name = "run",
           .page = "runs/run.html",
           .method = "track best",
           .module = "track",
           .dataset = "walls",
           .commit = "abc",
           .seed = seed,
           .problem = "",
           .scores = {{"trajectory.dt_rel_percent.mean", (i < 6 ? 0.5 : 0.6) + wobble}}});
    }
    reports.push_back(std::move(report));
  }
  const std::string page = method_page("track best", reports);
  const std::size_t table = page.find("Reports from which on a score has another level");
  ASSERT_NE(table, std::string::npos);
  EXPECT_THAT(page.substr(table), HasSubstr("../reports/r6/index.html\">Report 6</a>"));
  EXPECT_THAT(page.substr(table), HasSubstr("class=\"worse\""));
}

TEST_F(Publish, ARecordIsReadAsItWasWritten) {
  published({run()}, "One \"quoted\" </script> title");
  const std::vector<PublishedReport> reports = read_published_reports(site());
  ASSERT_EQ(reports.size(), 1U);
  EXPECT_EQ(reports[0].title, "One \"quoted\" </script> title");
  ASSERT_EQ(reports[0].runs.size(), 1U);
  EXPECT_EQ(reports[0].runs[0].method, "track accurate");
  EXPECT_EQ(reports[0].runs[0].page, "runs/walls_accurate.html");
  EXPECT_GT(reports[0].runs[0].scores.at("trajectory.dt_rel_percent.mean"), 0);
  EXPECT_EQ(to_json(reports[0]), read_file(site() / "reports" / reports[0].name / "scores.json"));
  for (const fs::path& page : pages())
    EXPECT_THAT(read_file(page), Not(HasSubstr("</script> title"))) << page;
}

TEST_F(Publish, ADamagedRecordIsNamed) {
  const fs::path report = published({run()}, "One").parent_path();
  std::ofstream(report / "scores.json") << "{\"title\": 3}";
  EXPECT_THAT(error_of([&] { static_cast<void>(read_published_reports(site())); }),
              HasSubstr("scores.json"));
  std::ofstream(report / "scores.json") << std::string(100000, '[');
  EXPECT_THAT(error_of([&] { static_cast<void>(read_published_reports(site())); }),
              HasSubstr("nested too deeply"));
}

TEST_F(Publish, LeavesAFolderOfOtherThingsAlone) {
  fs::create_directories(site());
  std::ofstream(site() / "thesis.tex") << "years of work";
  EXPECT_THAT(error_of([&] { published({run()}, "One"); }), HasSubstr("no site of reports"));
  EXPECT_EQ(read_file(site() / "thesis.tex"), "years of work");
}

TEST_F(Publish, RunsOfOneNameHavePagesOfTheirOwn) {
  const fs::path twin = folder_.path() / "twin" / run().filename();
  fs::create_directories(twin.parent_path());
  fs::copy(run(), twin, fs::copy_options::recursive);
  published({run(), twin}, "Twins");
  const std::vector<PublishedReport> reports = read_published_reports(site());
  EXPECT_EQ(reports[0].runs[0].page, "runs/walls_accurate.html");
  EXPECT_EQ(reports[0].runs[1].page, "runs/walls_accurate-2.html");
}

}  // namespace
}  // namespace saccade
