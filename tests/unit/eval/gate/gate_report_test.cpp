#include "eval/gate/gate_report.h"

#include <gtest/gtest.h>

namespace saccade {
namespace {

using Verdict = GateRow::Verdict;

/// One row of each kind.
GateResult sample() {
  GateRow slower;
  slower.verdict = Verdict::kRegressed;
  slower.metric = "trajectory.dt_rel_percent.mean";
  slower.scope = "track, 3 sequences";
  slower.pairs = 30;
  slower.before = 0.168;
  slower.after = 0.1764;
  slower.change = 0.05;
  slower.low = 0.03;
  slower.high = 0.07;
  slower.p = 0.0012;
  GateRow missing;
  missing.verdict = Verdict::kRegressed;
  missing.metric = "depth.rel_median";
  missing.scope = "walls, depth \"<best>|\", seed 1";
  missing.pairs = 1;
  missing.before = 0.001;
  missing.note = "missing";
  GateRow same;
  same.metric = "trajectory.coverage";
  same.scope = "walls, track accurate";
  same.pairs = 1;
  same.before = same.after = 0.998;
  same.change = 0;
  same.note = "few pairs, judged by 25 % alone";
  return {{slower, missing, same}, {"times not compared"}};
}

TEST(GateText, ShowsWhatCounts) {
  EXPECT_EQ(gate_text(sample(), false),
            "regressed  trajectory.dt_rel_percent.mean  track, 3 sequences              "
            "0.1680 -> 0.1764  +5.0 % [+3.0 %, +7.0 %]  p 0.0012, 30 pairs\n"
            "regressed  depth.rel_median                walls, depth \"<best>|\", seed 1  "
            "0.001000 -> –     missing                  1 pair\n"
            "note: times not compared\n"
            "2 regressed, 0 improved, 1 unchanged\n");
}

TEST(GateText, ShowsAllOnDemand) {
  EXPECT_NE(gate_text(sample(), true).find("0.9980 -> 0.9980  0.0 % "), std::string::npos);
  EXPECT_NE(gate_text(sample(), true).find("1 pair; few pairs, judged by 25 % alone"),
            std::string::npos);
}

TEST(GateAnnotations, AreWorkflowCommands) {
  EXPECT_EQ(
      gate_annotations(sample(), "base,line.yaml"),
      "::error file=base%2Cline.yaml,title=regressed%3A trajectory.dt_rel_percent.mean::track, "
      "3 sequences, 0.1680 -> 0.1764, +5.0 %25 [+3.0 %25, +7.0 %25], p 0.0012, 30 pairs\n"
      "::error file=base%2Cline.yaml,title=regressed%3A depth.rel_median::walls, depth "
      "\"<best>|\", seed 1, 0.001000 -> –, missing, 1 pair\n"
      "::warning file=base%2Cline.yaml,title=saccade gate::times not compared\n");
  EXPECT_EQ(gate_annotations({{}, {"a\nb"}}, ""), "::warning title=saccade gate::a%0Ab\n");
}

TEST(GateMarkdown, IsATable) {
  EXPECT_EQ(gate_markdown(sample()),
            "**saccade gate: tripped.** 2 regressed, 0 improved, 1 unchanged\n"
            "\n"
            "| | metric | scope | before -> after | change | evidence |\n"
            "|---|---|---|---|---|---|\n"
            "| regressed | trajectory.dt_rel_percent.mean | track, 3 sequences | 0.1680 -> 0.1764 "
            "| +5.0 % [+3.0 %, +7.0 %] | p 0.0012, 30 pairs |\n"
            "| regressed | depth.rel_median | walls, depth \"<best>\\|\", seed 1 | 0.001000 -> – | "
            "missing | 1 pair |\n"
            "\n"
            "Note: times not compared\n");
}

TEST(GateJunit, HasAFailureForEachRegression) {
  EXPECT_EQ(gate_junit(sample()),
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
            "<testsuite name=\"saccade gate\" tests=\"3\" failures=\"2\">\n"
            "  <testcase classname=\"track, 3 sequences\" "
            "name=\"trajectory.dt_rel_percent.mean\">\n"
            "    <failure message=\"0.1680 -&gt; 0.1764, +5.0 % [+3.0 %, +7.0 %], p 0.0012, 30 "
            "pairs\"/>\n"
            "  </testcase>\n"
            "  <testcase classname=\"walls, depth &quot;&lt;best&gt;|&quot;, seed 1\" "
            "name=\"depth.rel_median\">\n"
            "    <failure message=\"0.001000 -&gt; –, missing, 1 pair\"/>\n"
            "  </testcase>\n"
            "  <testcase classname=\"walls, track accurate\" name=\"trajectory.coverage\"/>\n"
            "</testsuite>\n");
}

}  // namespace
}  // namespace saccade
