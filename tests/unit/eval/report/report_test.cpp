#include "eval/report/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/io/run/run_record.h"
#include "core/io/trajectory_file.h"
#include "eval/evaluate.h"
#include "eval/report/charts/page_data.h"
#include "eval/score_inputs.h"
#include "tests/support/html_page.h"
#include "tests/unit/eval/fake_folders.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::TemporaryFolder;

class Report : public testing::FakeFolders {
 protected:
  [[nodiscard]] std::string written(const std::vector<fs::path>& runs) {
    write_report(runs, folder.path() / "report.html");
    return testing::read_file(folder.path() / "report.html");
  }

  /// Another run with the same scores.
  [[nodiscard]] fs::path twin() const {
    const fs::path copy = folder.path() / "twin" / run().filename();
    fs::create_directories(copy.parent_path());
    fs::copy(run(), copy, fs::copy_options::recursive | fs::copy_options::overwrite_existing);
    return copy;
  }

  TemporaryFolder folder;
};

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++n;
  return n;
}

TEST_F(Report, NeedsNothingBesideIt) {
  const std::string page = written({run()});
  EXPECT_EQ(count(page, "src=\""), count(page, "src=\"data:image/webp;base64,"));
  EXPECT_GT(count(page, "src=\""), 3U);
  EXPECT_THAT(testing::external_references(page), ::testing::IsEmpty());
  for (const char* outside : {"<link", "@import", "fetch("})
    EXPECT_EQ(count(page, outside), 0U) << outside;
  EXPECT_EQ(count(page, "{{"), 0U);
}

TEST_F(Report, NamesBringNoMarkupAndNoScript) {
  const std::string hostile = "\"'><img src=x onerror=alert(1)></script><script>alert(2)</script>";
  const fs::path run_folder = folder.path() / "<b onmouseover=alert(3)>run";
  fs::copy(run(), run_folder, fs::copy_options::recursive);
  RunRecord record = read_run_record(run_folder / "run.yaml");
  record.module = "track" + hostile;
  record.command = "saccade run track -c " + hostile + ".yaml";
  record.tool_version = hostile;
  record.machine = hostile;
  record.config_yaml = "note: \"" + std::string("</textarea><script>alert(4)</script>") + "\"\n";
  write_run_record(run_folder / "run.yaml", record);
  const std::string page = written({run_folder});
  EXPECT_GT(count(page, "alert(3)"), 0U) << "the name is not shown at all";
  for (const char* markup : {"<img src=x", "<script>alert", "<b onmouseover", "</textarea><script"})
    EXPECT_EQ(count(page, markup), 0U) << markup;
}

TEST_F(Report, ShowsTheRunBesideTheThesis) {
  const std::string page = written({run()});
  for (const char* text : {"walls_accurate", "better by", "1.3", "Table 8.3 prints 204 M",
                           "saccade run track --data corner", "event_map_ratio: 0.4"})
    EXPECT_GE(count(page, text), 1U) << text;
}

TEST_F(Report, ShowsWhereAMethodErrsMostAndItsRelativeErrors) {
  const std::string page = written({run()});
  EXPECT_EQ(count(page, "id=\"failures\""), 1U);
  EXPECT_GE(count(page, "% of the depth, "), 1U);
  EXPECT_EQ(count(page, "id=\"segments\""), 1U);
  EXPECT_GE(count(page, "<svg class=\"boxes\""), 2U);
}

TEST_F(Report, OfManyRunsIsCompressedWithPicturesOfTheFirst) {
  std::vector<fs::path> runs;
  for (int i = 0; i < 41; ++i) {
    runs.push_back(folder.path() / "many" / ("run_" + std::to_string(i)));
    fs::create_directories(runs.back().parent_path());
    fs::copy(run(), runs.back(), fs::copy_options::recursive);
  }
  const std::string page = written(runs);
  EXPECT_EQ(count(page, "class=\"packed\">"), runs.size());
  for (std::size_t i = 1; i <= runs.size(); ++i)
    EXPECT_EQ(count(page, "<section id=\"run" + std::to_string(i) + "\""), 1U);
  EXPECT_EQ(count(page, "data-run="), 0U);  // inside the compressed sections
  const std::string one = written({runs.front()});
  EXPECT_LT(page.size(), one.size() + runs.size() * 60000);
}

void expect_links_lead_somewhere(const std::string& page) {
  for (std::size_t at = 0; (at = page.find("href=\"#", at)) != std::string::npos; ++at) {
    const std::size_t begin = at + 7;
    const std::string id = page.substr(begin, page.find('"', begin) - begin);
    EXPECT_EQ(count(page, "id=\"" + id + "\""), 1U) << id;
  }
}

TEST_F(Report, EveryLinkLeadsToASection) { expect_links_lead_somewhere(written({run(), twin()})); }

TEST_F(Report, HasAReliabilityDiagramWhereProbabilitiesAreStated) {
  EXPECT_EQ(count(written({run()}), "id=\"reliability\""), 0U);
  const fs::path stated = folder.path() / "stated";
  fs::copy(run(), stated, fs::copy_options::recursive);
  std::ofstream(stated / "poses.csv") << "t_s,status,probability\n0.0,ok,0.97\n0.5,ok,0.4\n";
  const std::string page = written({stated});
  EXPECT_EQ(count(page, "id=\"reliability\""), 1U);
  EXPECT_EQ(count(page, "data-chart=\"reliability\""), 1U);
  expect_links_lead_somewhere(page);
}

TEST_F(Report, ShowsTheAngularVelocityOfARunThatFoundOne) {
  EXPECT_EQ(count(written({run()}), "Angular velocity</h4>"), 0U);
  const fs::path with_rates = folder.path() / "with_rates";
  fs::copy(run(), with_rates, fs::copy_options::recursive);
  write_angular_velocities(with_rates / "angular_velocity.txt", {});
  EXPECT_EQ(count(written({with_rates}), "Angular velocity</h4>"), 0U);
  const std::vector<StampedTwist> rates = {{0.1, Eigen::Vector3d::Zero(), {1, 2, 3}},
                                           {0.2, Eigen::Vector3d::Zero(), {1, 0, 3}}};
  write_angular_velocities(with_rates / "angular_velocity.txt", rates);
  EXPECT_EQ(count(written({with_rates}), "Angular velocity</h4>"), 1U);
}

TEST_F(Report, LeavesOutWhatTheRunLacks) {
  const fs::path bare = folder.path() / "bare";
  fs::copy(run(), bare, fs::copy_options::recursive);
  for (const char* file : {"timing.json", "poses.csv", "map.ply", "trajectory.txt"})
    fs::remove(bare / file);
  fs::remove(bare / "metrics.json");
  const std::string page = written({bare});
  expect_links_lead_somewhere(page);
  EXPECT_EQ(count(page, "id=\"speed\""), 0U);
  EXPECT_EQ(count(page, "id=\"accuracy\""), 0U);
  EXPECT_EQ(count(page, ">nan"), 0U);
}

TEST_F(Report, IsTheSameEveryTime) { EXPECT_EQ(written({run()}), written({run()})); }

/// Has metrics.json of the run state another mean error, with the same inputs.
void state_error(const fs::path& run, double dt_rel_percent) {
  Metrics metrics = read_json_metrics(run / "metrics.json");
  metrics.set("trajectory.dt_rel_percent.mean", dt_rel_percent);
  const std::string text = to_json(metrics, recorded_inputs(run));
  std::ofstream(run / "metrics.json") << text;
}

TEST_F(Report, ShowsWhatEvalScored) {
  const fs::path scored = twin();
  (void)evaluate_run(scored);
  const std::string fresh = written({scored});
  fs::remove(scored / "metrics.json");
  EXPECT_EQ(written({scored}), fresh) << "it is scored again";
  (void)evaluate_run(scored);
  state_error(scored, 42.42);
  EXPECT_GE(count(written({scored}), "42.42"), 1U);
  std::ofstream(scored / "poses.csv", std::ios::app) << "\n";
  EXPECT_EQ(count(written({scored}), "42.42"), 0U) << "the scores are stale";
}

TEST_F(Report, WithoutTheDatasetTheStoredScoresRemain) {
  (void)evaluate_run(run());
  const fs::path copy = folder.path() / "walls_copy";
  fs::copy(run(), copy, fs::copy_options::recursive);
  std::string record = testing::read_file(copy / "run.yaml");
  const std::size_t at = record.find(dataset().string());
  ASSERT_NE(at, std::string::npos);
  record.replace(at, dataset().string().size(), "/gone/walls");
  folder.write("walls_copy/run.yaml", record);
  const std::string page = written({copy});
  EXPECT_EQ(count(page, "/gone/walls is not there"), 1U);
  EXPECT_EQ(count(page, "src=\""), 0U);
  EXPECT_GE(count(page, "3,030"), 1U);
}

TEST_F(Report, RefusesWhatIsNoRun) {
  EXPECT_THROW(write_report({}, folder.path() / "r.html"), InputError);
  const std::vector<fs::path> none{folder.path()};
  EXPECT_THROW(write_report(none, folder.path() / "r.html"), InputError);
  EXPECT_FALSE(fs::exists(folder.path() / "r.html"));
}

TEST_F(Report, LongSeriesKeepTheirPeaks) {
  RunData data;
  data.id = "run1";
  for (int i = 0; i < 20000; ++i) {
    data.samples.t_s.push_back(i * 1e-3);
    data.samples.estimated.emplace_back();
    data.samples.truth.emplace_back();
    data.errors.dt_m.push_back(i == 12345 ? 7.0 : 0.001);
    data.errors.dtheta_deg.push_back(1);
  }
  data.errors.t_s = data.samples.t_s;
  const auto json = nlohmann::json::parse(run_page_data(data));
  const auto& dt = json["series"]["dt"];
  EXPECT_LE(dt["v"].size(), 1700U);
  const std::vector<double> values = dt["v"];
  const auto peak = std::find(values.begin(), values.end(), 7000.0);
  ASSERT_NE(peak, values.end());
  EXPECT_EQ(dt["t"][static_cast<std::size_t>(peak - values.begin())], 12.345);
  EXPECT_EQ(json["gaps"].size(), 1U);
}

/// The chart of the page's data with that id.
nlohmann::json chart_of(const std::string& page, const std::string& id) {
  const std::string open = "id=\"charts\">";
  const std::size_t begin = page.find(open) + open.size();
  const auto charts =
      nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
  for (const auto& chart : charts)
    if (chart["id"] == id) return chart;
  return {};
}

TEST_F(Report, ARunThatIsNamedTwiceIsShownOnce) {
  EXPECT_EQ(written({run(), run() / "."}), written({run()}));
}

TEST_F(Report, OneMethodIsComparedWithNothing) {
  const std::string page = written({run(), twin()});
  EXPECT_EQ(count(page, "id=\"compared\""), 0U);
  EXPECT_EQ(count(page, "<div data-chart="), 0U);
}

TEST_F(Report, ComparesTheMethodsOfASequence) {
  testing::FakeErrors errors;
  errors.slow_m = 0.02;
  testing::write_fake_run(folder.path() / "walls_fast", dataset(), errors, "fast");
  const std::string page = written({run(), twin(), folder.path() / "walls_fast"});
  EXPECT_EQ(count(page, "id=\"compared\""), 1U);
  for (const char* id : {"walls/dt_rel/time", "walls/dt_rel/fractions", "walls/dtheta/time",
                         "walls/dtheta/fractions", "/trajectory.dt_rel_percent.mean/speed"})
    EXPECT_EQ(count(page, "data-chart=\"" + std::string(id) + "\""), 1U) << id;
  EXPECT_EQ(count(page, "walls/trajectory.dt_rel_percent.mean/speed"), 0U)
      << "the mean over one sequence is the sequence's";
  const auto fractions = chart_of(page, "walls/dt_rel/fractions");
  ASSERT_EQ(fractions["series"].size(), 2U) << "runs of one method are pooled";
  EXPECT_EQ(fractions["series"][0]["name"], "track accurate");
  EXPECT_EQ(fractions["series"][1]["name"], "track fast");
  EXPECT_LT(fractions["series"][0]["x"][50], fractions["series"][1]["x"][50]);
  EXPECT_EQ(chart_of(page, "/trajectory.dt_rel_percent.mean/speed")["series"].size(), 3U)
      << "the front and two methods";
}

/// Has the fake run of a folder say other values of its configuration.
void change_values(const fs::path& run) {
  std::string record = testing::read_file(run / "run.yaml");
  const std::string value = "event_map_ratio: 0.4";
  ASSERT_EQ(count(record, value), 1U);
  std::ofstream(run / "run.yaml") << record.replace(record.find(value), value.size(),
                                                    "event_map_ratio: 0.5");
}

TEST_F(Report, TwoConfigurationsOfOneNameAreTwoMethods) {
  const auto written_run = [&](const std::string& name, const std::string& configuration) {
    testing::write_fake_run(folder.path() / name, dataset(), {}, configuration);
    return folder.path() / name;
  };
  const std::vector<fs::path> runs{written_run("mine", "accurate"),
                                   written_run("alike", "a/accurate"),
                                   written_run("theirs", "theirs/accurate")};
  EXPECT_EQ(count(written(runs), "id=\"compared\""), 0U) << "the same values";
  change_values(runs[2]);
  const auto chart = chart_of(written(runs), "walls/dt_rel/time");
  ASSERT_EQ(chart["series"].size(), 2U) << "those of the same values are one";
  EXPECT_EQ(chart["series"][0]["name"], "track accurate (.)");
  EXPECT_EQ(chart["series"][1]["name"], "track accurate (theirs)");
}

TEST_F(Report, AFileThatWasChangedBetweenTheRunsIsTwoMethods) {
  const std::vector<fs::path> runs{folder.path() / "before", folder.path() / "after"};
  for (const fs::path& run : runs) testing::write_fake_run(run, dataset(), {}, "accurate");
  change_values(runs[1]);
  const auto chart = chart_of(written(runs), "walls/dt_rel/time");
  ASSERT_EQ(chart["series"].size(), 2U);
  const std::string first = chart["series"][0]["name"], second = chart["series"][1]["name"];
  EXPECT_THAT(first, ::testing::MatchesRegex("track accurate \\([0-9a-f]{8}\\)"));
  EXPECT_NE(first, second);
}

TEST_F(Report, APublishedSpeedStandsInTheChart) {
  const auto table = [](const std::string& metric, const std::string& value) {
    return "  - {dataset: D, metric: " + metric +
           ", protocol: p, citation: c, url: \"https://example.org\", methods: [{name: M, "
           "sensors: events, paper: \"https://example.org\"}], sequences: {walls: [" +
           value + "]}}\n";
  };
  ReportOptions options;
  options.published =
      folder.write("published.yaml", "tables:\n" + table("trajectory.dt_rel_percent.mean", "0.5") +
                                         table("speed.realtime_factor", "3"));
  const fs::path file = folder.path() / "report.html";
  write_report(std::vector{run()}, file, options);
  const auto chart = chart_of(testing::read_file(file), "/trajectory.dt_rel_percent.mean/speed");
  EXPECT_EQ(chart["series"].size(), 3U) << "the front, the run's method and the published one";
}

TEST_F(Report, SaysHowEveryPartIsRepeated) {
  ReportOptions options;
  options.command = "saccade report a b -o c.html --title \"<x>\"";
  const fs::path file = folder.path() / "report.html";
  write_report(std::vector{run(), twin()}, file, options);
  const std::string page = testing::read_file(file);
  EXPECT_EQ(count(page, "</section>"), count(page, "<summary>Repeat</summary>"));
  EXPECT_GE(count(page, "saccade report a b -o c.html --title &quot;&lt;x&gt;&quot;\n</pre>"), 3U);
  for (const fs::path& shown : {run(), twin()})
    EXPECT_EQ(count(page, "saccade render " + shown.string() + " -o walls_accurate.mp4"), 1U);
}

TEST_F(Report, ShowsAFilmOfEveryRunThatHasOne) {
  if (std::system("command -v ffmpeg >/dev/null") != 0) GTEST_SKIP() << "needs ffmpeg";
  ReportOptions options;
  options.film = true;
  const fs::path file = folder.path() / "report.html";
  write_report(std::vector{run(), twin()}, file, options);
  const std::string page = testing::read_file(file);
  EXPECT_EQ(count(page, "<video "), 2U);
  EXPECT_EQ(count(page, "src=\"data:video/mp4;base64,"), 2U);
  EXPECT_EQ(count(page, "poster=\"data:image/webp;base64,"), 2U);
  EXPECT_THAT(testing::external_references(page), ::testing::IsEmpty());
}

TEST_F(Report, HoldsRunsAgainstOthers) {
  const fs::path before = folder.path() / "walls_accurate";
  testing::FakeErrors errors;
  errors.slow_m = 0.02;
  testing::write_fake_run(before, dataset(), errors, "accurate");
  const fs::path file = folder.path() / "against.html";
  ReportOptions options;
  options.against = {before};
  options.exports = folder.path() / "tables";
  write_report(std::vector{run()}, file, options);
  const std::string page = testing::read_file(file);
  EXPECT_EQ(count(page, "<h2>A against B</h2>"), 1U);
  EXPECT_GE(count(page, "<span class=\"better\">better</span>"), 1U);
  const auto chart = chart_of(page, "against/data, track accurate/dt_rel/time");
  ASSERT_EQ(chart["series"].size(), 2U);
  EXPECT_EQ(chart["series"][0]["name"], "A: before");
  EXPECT_THAT(testing::read_file(folder.path() / "tables/against.csv"),
              ::testing::HasSubstr("trajectory.dt_rel_percent.mean,1,"));
}

}  // namespace
}  // namespace saccade
