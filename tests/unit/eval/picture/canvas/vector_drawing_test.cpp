#include "eval/picture/canvas/vector_drawing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <string>

#include "eval/picture/canvas/canvas.h"
#include "eval/picture/chart/bar_chart.h"
#include "eval/picture/chart/line_chart.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

using ::testing::HasSubstr;
using testing::read_file;
using ::testing::StartsWith;
using testing::TemporaryFolder;

LineChart chart() {
  LineChart chart;
  chart.x_label = "samples";
  chart.names = {"walls", "planes"};
  LineChart::Panel panel{"error [%]", {}};
  panel.lines = {{{10, {0.5, 0.4, 0.6}}, {20, {0.3, 0.2, 0.35}}}, {{10, {0.7, 0.7, 0.7}}}};
  chart.panels = {panel};
  return chart;
}

TEST(VectorDrawing, APdfHoldsItsFont) {
  const TemporaryFolder folder;
  save(chart(), std::array{folder.path() / "a.pdf"});
  const std::string pdf = read_file(folder.path() / "a.pdf");
  EXPECT_THAT(pdf, StartsWith("%PDF-"));
  EXPECT_THAT(pdf, HasSubstr("/FontFile")) << "journals refuse fonts that are not in the file";
  EXPECT_THAT(pdf, HasSubstr("/MediaBox [ 0 0 300 "));  // 400 px of 3/4 point
}

TEST(VectorDrawing, EqualChartsAreEqualFiles) {
  const TemporaryFolder folder;
  for (const char* name : {"a", "b"})
    save(chart(), std::array{folder.path() / (std::string(name) + ".pdf"),
                             folder.path() / (std::string(name) + ".svg")});
  for (const char* ending : {".pdf", ".svg"})
    EXPECT_EQ(read_file(folder.path() / (std::string("a") + ending)),
              read_file(folder.path() / (std::string("b") + ending)));
  EXPECT_THAT(read_file(folder.path() / "a.svg"), HasSubstr("<svg"));
}

TEST(VectorDrawing, MeasuresTheLettersThatItDraws) {
  const VectorDrawing drawing;
  EXPECT_EQ(drawing.extent_of("", 9), 0);
  EXPECT_NEAR(drawing.extent_of("walls", 18), 2 * drawing.extent_of("walls", 9), 1e-6);
  EXPECT_GT(drawing.extent_of("wallswalls", 9), 1.9 * drawing.extent_of("walls", 9));
  // Letters of a capital's height of 9 are about as wide as those of the pictures.
  EXPECT_NEAR(drawing.extent_of("dt_rel, mean", 9), Canvas::text_width("dt_rel, mean", 9), 20);
}

TEST(VectorDrawing, LeavesOutWhatIsNowhere) {
  const TemporaryFolder folder;
  VectorDrawing drawing;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  drawing.line({0, 0}, {nan, 5}, {255, 0, 0});
  drawing.disc({nan, nan}, 3, {255, 0, 0});
  drawing.rectangle({1, 1}, {5, 5}, {0, 0, 255});
  drawing.save(folder.path() / "a.svg", 20, 20);
  const std::string svg = read_file(folder.path() / "a.svg");
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_THAT(svg, HasSubstr("width=\"15"));
}

TEST(VectorDrawing, NamesTheFileThatItCannotWrite) {
  BarChart bars;
  bars.categories = {"a"};
  bars.names = {"b"};
  bars.panels = {{"error", {{ChartValue{1, 1, 1}}}}};
  const TemporaryFolder folder;
  folder.write("file", "");
  EXPECT_THAT(testing::error_of([&] { save(bars, std::array{folder.path() / "file" / "a.pdf"}); }),
              HasSubstr("a.pdf"));
}

}  // namespace
}  // namespace saccade

/// LeakSanitizer: fontconfig keeps the fonts that a program has asked for until its end.
extern "C" const char* __lsan_default_suppressions() { return "leak:libfontconfig"; }
