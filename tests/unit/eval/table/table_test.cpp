#include "eval/table/table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/command.h"

namespace saccade {
namespace {

using ::testing::HasSubstr;

Table table() {
  return {"errors",
          "dt_rel, mean [%]: lower is better",
          {{"method"}, {"rank", true}, {"walls_1", true}},
          {{{"a_b & {50 %}", {}, "from <there>"},
            {"1", PooledValue{1, {}, {}, 1}},
            {"", PooledValue{0.12345, 0.1, 0.2, 3}, "", true}},
           {{"[x], y", {}}, {"0 of 1", {}}, {"–", {}}}}};
}

TEST(Table, ATerminalShowsAlignedColumns) {
  EXPECT_EQ(table_text(table()),
            "method          rank               walls_1\n"
            "a_b & {50 %}       1  0.123 [0.100, 0.200]\n"
            "[x], y        0 of 1                     –\n");
}

TEST(Table, WithoutTitlesThereIsNoRowOfThem) {
  Table plain{.columns = {{""}, {""}}};
  plain.add({"a", "b"});
  EXPECT_EQ(table_text(plain), "a  b\n");
}

TEST(Table, MarkdownEscapesTheBarAndMarksTheBest) {
  Table bars = table();
  bars.rows[0][0].text = "a|b";
  EXPECT_EQ(table_markdown(bars),
            "| method | rank | walls_1 |\n|---|---:|---:|\n"
            "| a\\|b | 1 | **0.123** [0.100, 0.200] |\n"
            "| [x], y | 0 of 1 | – |\n");
}

TEST(Table, LatexIsEscapedAndSetWithBooktabs) {
  EXPECT_EQ(table_latex(table()),
            "% dt_rel, mean [%]: lower is better\n"
            "\\begin{tabular}{lrr}\n\\toprule\n"
            "method & rank & walls\\_1 \\\\\n\\midrule\n"
            "a\\_b \\& \\{50 \\%\\} & 1 & \\textbf{0.123} [0.100, 0.200] \\\\\n"
            "{[}x], y & 0 of 1 & -- \\\\\n"
            "\\bottomrule\n\\end{tabular}\n");
}

TEST(Table, CsvIsUnroundedWithIntervals) {
  EXPECT_EQ(table_csv(table()),
            "method,rank,walls_1,walls_1 low,walls_1 high,walls_1 n\n"
            "a_b & {50 %},1,0.12345,0.1,0.2,3\n"
            "\"[x], y\",0 of 1,,,,0\n");
}

TEST(Table, HtmlCarriesItsFilesAndTheValuesToSortBy) {
  const std::string html = table_html(table());
  for (const char* part :
       {"data-value=\"0.12345\"><b>0.123</b>", "from &lt;there&gt;", "data-latex=\"% dt_rel",
        "data-csv=\"method,rank", "&quot;[x], y&quot;", "<th>walls_1</th>"})
    EXPECT_THAT(html, HasSubstr(part));
}

TEST(Table, ExportsBothFiles) {
  const testing::TemporaryFolder folder;
  export_tables(std::vector{table()}, folder.path() / "new");
  EXPECT_EQ(testing::read_file(folder.path() / "new/errors.tex"), table_latex(table()));
  EXPECT_EQ(testing::read_file(folder.path() / "new/errors.csv"), table_csv(table()));
}

}  // namespace
}  // namespace saccade
