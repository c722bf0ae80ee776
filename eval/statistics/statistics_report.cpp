#include "eval/statistics/statistics_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/io/events/event_file.h"
#include "core/io/images/image_file.h"
#include "core/io/tables/csv_file.h"
#include "core/process/progress.h"
#include "eval/picture/chart/line_chart.h"
#include "eval/statistics/stream_counter.h"
#include "eval/table/number_text.h"
#include "eval/table/table.h"

namespace saccade {
namespace fs = std::filesystem;
namespace {

/// Rate of the pixel below which the fraction `quantile` of all pixels lies [1/s].
double pixel_quantile_hz(const StreamStatistics& s, double quantile) {
  const std::vector<double>& all = s.pixels.ascending_hz;
  return all[static_cast<std::size_t>(quantile * static_cast<double>(all.size() - 1))];
}

struct Quantity {
  const char* key;
  const char* label;
  double (*value)(const StreamStatistics&);
};

using S = const StreamStatistics&;

constexpr std::array<Quantity, 17> kQuantities{{
    {"events", "events", [](S s) { return static_cast<double>(s.events); }},
    {"duration_s", "duration [s]", [](S s) { return s.duration_s; }},
    {"on_percent", "ON events [%]", [](S s) { return 100 * s.on_fraction; }},
    {"pixel_rate_hz", "events/s of a pixel, mean", [](S s) { return s.pixel_rate_hz; }},
    {"pixel_median_hz", "... median", [](S s) { return pixel_quantile_hz(s, 0.5); }},
    {"pixel_90_hz", "... 90 % are below", [](S s) { return pixel_quantile_hz(s, 0.9); }},
    {"pixel_99_hz", "... 99 % are below", [](S s) { return pixel_quantile_hz(s, 0.99); }},
    {"silent_percent", "pixels without events [%]",
     [](S s) { return 100 * s.pixels.silent_fraction; }},
    {"hot_pixels", "hot pixels", [](S s) { return static_cast<double>(s.pixels.hot_pixels); }},
    {"shortest_gap_us", "shortest gap [us]", [](S s) { return s.gaps.shortest_us; }},
    {"floor_gap_us", "0.1 % of gaps are below [us]", [](S s) { return s.gaps.floor_us; }},
    {"median_gap_us", "median gap [us]", [](S s) { return s.gaps.median_us; }},
    {"opposite_percent", "gaps that change polarity [%]",
     [](S s) { return 100 * s.gaps.opposite_fraction; }},
    {"isolated_percent", "isolated events [%]",
     [](S s) { return 100 * s.noise.isolated_fraction; }},
    {"isolated_hz", "... of a pixel [1/s]", [](S s) { return s.noise.isolated_hz; }},
    {"quiet_on_hz", "ON of a quiet pixel [1/s]", [](S s) { return s.noise.quiet_on_hz; }},
    {"quiet_off_hz", "OFF of a quiet pixel [1/s]", [](S s) { return s.noise.quiet_off_hz; }},
}};

using Line = std::vector<LineChart::Point>;

LineChart::Point chart_point(double x, double y) { return {x, {y, y, y}}; }

Line rate_line(const StreamStatistics& s) {
  Line line;
  const auto pixels = static_cast<double>(s.pixels.ascending_hz.size());
  for (const RateBin& bin : s.rates)
    line.push_back(chart_point(bin.t_s, (bin.on_hz + bin.off_hz) / pixels));
  return line;
}

/// Fraction of all gaps in each bin [%], from the first to the last bin that holds any.
Line gap_line(const LogHistogram& of, const EventGaps& gaps) {
  double all = 0;
  std::size_t first = of.bins(), last = 0;
  for (std::size_t i = 0; i < of.bins(); ++i) {
    all += static_cast<double>(gaps.same.count(i) + gaps.opposite.count(i));
    if (of.count(i) == 0) continue;
    first = std::min(first, i);
    last = i;
  }
  Line line;
  for (std::size_t i = first; i < of.bins() && i <= last; ++i)
    line.push_back(chart_point(of.middle(i), 100 * static_cast<double>(of.count(i)) / all));
  return line;
}

Line pixel_line(const StreamStatistics& s) {
  Line line;
  for (int percent = 0; percent < 100; percent += 4)
    line.push_back(chart_point(percent, pixel_quantile_hz(s, percent / 100.0)));
  line.push_back(chart_point(99, pixel_quantile_hz(s, 0.99)));
  return line;
}

CsvTable quantity_table(std::span<const StreamStatistics> recordings) {
  std::vector<std::string> columns{"recording"};
  for (const Quantity& quantity : kQuantities) columns.emplace_back(quantity.key);
  CsvTable table(columns);
  for (const StreamStatistics& recording : recordings) {
    std::vector<CsvTable::Cell> cells{recording.name};
    for (const Quantity& quantity : kQuantities) cells.emplace_back(quantity.value(recording));
    table.add(cells);
  }
  return table;
}

CsvTable rate_table(std::span<const StreamStatistics> recordings) {
  CsvTable table({"recording", "t_s", "on_hz", "off_hz"});
  for (const StreamStatistics& recording : recordings)
    for (const RateBin& bin : recording.rates)
      table.add({recording.name, bin.t_s, bin.on_hz, bin.off_hz});
  return table;
}

CsvTable gap_table(std::span<const StreamStatistics> recordings) {
  CsvTable table({"recording", "from_us", "to_us", "same_polarity", "other_polarity"});
  for (const StreamStatistics& recording : recordings) {
    const EventGaps& gaps = recording.gaps;
    for (std::size_t i = 0; i < gaps.same.bins(); ++i)
      table.add({recording.name, gaps.same.lower(i), gaps.same.lower(i + 1),
                 static_cast<long long>(gaps.same.count(i)),
                 static_cast<long long>(gaps.opposite.count(i))});
  }
  return table;
}

constexpr double kLongest_s = 86400;

std::string seconds_text(const Event& event) {
  return fmt::format("{:.6f} s", seconds_from_ns(event.t_ns));
}

}  // namespace

StreamStatistics statistics_of_recording(const fs::path& path, const RecordingPart& part) {
  const RecordingSource source = find_recording(path, part);
  EventStream stream(source.file, source.size, source.window);
  Progress progress("counting " + source.name, stream.expected_count(), "events");
  StreamCounter counter(source.size);
  std::optional<Event> first, last;
  for (auto events = stream.next(); !events.empty(); events = stream.next()) {
    if (!first) first = events.front();
    last = events.back();
    // In doubles: of damaged times even the difference may be beyond 64 bits.
    if (seconds_from_ns(last->t_ns) - seconds_from_ns(first->t_ns) > kLongest_s)
      throw InputError(source.file.string(),
                       "spans more than a day, from " + seconds_text(*first) + " to " +
                           seconds_text(*last) +
                           " at least; --start-s and --duration-s choose a part");
    counter.add(events);
    progress.add(events.size());
  }
  if (!first || first->t_ns == last->t_ns)
    throw InputError(source.file.string(), "holds no two events at different times in this part");
  StreamStatistics statistics = std::move(counter).statistics();
  statistics.name = source.name;
  return statistics;
}

std::string statistics_table(std::span<const StreamStatistics> recordings) {
  Table table{.columns = {{""}}};
  for (const StreamStatistics& recording : recordings)
    table.columns.push_back({recording.name, true});
  for (const Quantity& quantity : kQuantities) {
    std::vector<std::string> cells{quantity.label};
    for (const StreamStatistics& recording : recordings)
      cells.push_back(rounded(quantity.value(recording)));
    table.add(cells);
  }
  return table_text(table);
}

ImageRgb8 draw_statistics(std::span<const StreamStatistics> recordings) {
  LineChart chart;
  chart.panels = {{"events/s of a pixel", {}, "time from the first event [s]"},
                  {"gaps to the same polarity [%]", {}, "gap [us]"},
                  {"gaps to the other polarity [%]", {}, "gap [us]"},
                  {"events/s of a pixel", {}, "pixels with fewer [%]"}};
  for (const StreamStatistics& recording : recordings) {
    chart.names.push_back(recording.name);
    chart.panels[0].lines.push_back(rate_line(recording));
    chart.panels[1].lines.push_back(gap_line(recording.gaps.same, recording.gaps));
    chart.panels[2].lines.push_back(gap_line(recording.gaps.opposite, recording.gaps));
    chart.panels[3].lines.push_back(pixel_line(recording));
  }
  return draw(chart, kLightTheme);
}

void write_statistics(std::span<const StreamStatistics> recordings,
                      const std::filesystem::path& folder) {
  quantity_table(recordings).save(folder / "statistics.csv");
  rate_table(recordings).save(folder / "rates.csv");
  gap_table(recordings).save(folder / "gaps.csv");
  write_png(folder / "statistics.png", draw_statistics(recordings));
}

}  // namespace saccade
