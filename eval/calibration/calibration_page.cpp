#include "eval/calibration/calibration_page.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "core/io/files/atomic_file.h"
#include "eval/picture/canvas/canvas.h"
#include "eval/picture/canvas/contact_sheet.h"
#include "eval/picture/image/event_picture.h"
#include "eval/report/html.h"
#include "eval/report/page.h"
#include "eval/statistics/statistics_report.h"
#include "eval/statistics/stream_counter.h"
#include "eval/table/number_text.h"

namespace saccade {
namespace {

struct NamedParameter {
  const char* name;
  const char* unit;
  std::optional<double> SensorParameters::*member;
};

constexpr std::array<NamedParameter, 11> kParameters{{
    {"contrast_on", "log units", &SensorParameters::contrast_on},
    {"contrast_off", "log units", &SensorParameters::contrast_off},
    {"log_eps", "of white", &SensorParameters::log_eps},
    {"mismatch.sigma", "of the threshold", &SensorParameters::mismatch_sigma},
    {"refractory.period_us", "us", &SensorParameters::refractory_us},
    {"leak.rate_hz", "1/s", &SensorParameters::leak_hz},
    {"shot.rate_hz", "1/s", &SensorParameters::shot_hz},
    {"bandwidth.cutoff_hz", "Hz", &SensorParameters::cutoff_hz},
    {"hot.fraction", "of the pixels", &SensorParameters::hot_fraction},
    {"hot.rate_hz", "1/s", &SensorParameters::hot_hz},
    {"hot.sigma", "of ln rate", &SensorParameters::hot_sigma},
}};

std::string interval_text(const SensorFile& sensor, const std::string& name) {
  const auto found = sensor.intervals.find(name);
  if (found == sensor.intervals.end()) return "-";
  return significant(found->second[0]) + " to " + significant(found->second[1]);
}

std::string remark_of(const SensorFile& sensor, const std::string& name) {
  const auto found = sensor.remarks.find(name);
  return found == sensor.remarks.end() ? "" : found->second;
}

std::string section(const std::string& title, const std::string& body) {
  return fmt::format("<section>\n<h2>{}</h2>\n{}</section>\n", title, body);
}

std::string stretch_section(const RepeatedStretch& stretch) {
  std::array<StreamStatistics, 2> statistics{stream_statistics(stretch.recorded, stretch.size),
                                             stream_statistics(stretch.simulated, stretch.size)};
  statistics[0].name = "recorded";
  statistics[1].name = "simulated";
  const auto picture = [&](const Events& events, const char* caption) {
    return upscaled_figure(
        draw_events(events, stretch.size.width, stretch.size.height, kLightTheme), caption,
        caption);
  };
  return section(
      escape_html(stretch.name),
      figure(draw_statistics(statistics),
             "Rate over time, gaps and the pixels' rates, recorded and simulated.", "statistics") +
          picture(stretch.recorded, "Recorded events of the compared pixels.") +
          picture(stretch.simulated, "The same, simulated."));
}

std::string remark_list(const std::vector<std::string>& remarks) {
  std::string html = "<ul>\n";
  for (const std::string& remark : remarks) html += "<li>" + escape_html(remark) + "</li>\n";
  return html + "</ul>\n";
}

}  // namespace

Table parameter_table(const SensorFile& sensor) {
  Table table{.columns = {{"parameter"}, {"value", true}, {"95 %", true}, {"unit"}, {"rests on"}}};
  for (const NamedParameter& p : kParameters) {
    const std::optional<double>& value = sensor.events.*p.member;
    const std::string remark = remark_of(sensor, p.name);
    if (!value && remark.empty()) continue;
    table.add({p.name, value ? significant(*value) : "not told", interval_text(sensor, p.name),
               value ? p.unit : "", remark});
  }
  for (const auto& [name, value] : {std::pair{"measured.noise_on_hz", sensor.noise_on_hz},
                                    {"measured.noise_off_hz", sensor.noise_off_hz},
                                    {"estimators.contrast_on", sensor.effective_contrast_on},
                                    {"estimators.contrast_off", sensor.effective_contrast_off}})
    if (value)
      table.add(
          {name, significant(*value), interval_text(sensor, name), "", remark_of(sensor, name)});
  return table;
}

Table distance_table(const CalibrationSummary& summary) {
  Table table{.columns = {{"stretch"}}};
  table.add_numeric({"recorded", "simulated / recorded", "ON points", "gaps [decades]",
                     "rate (0..1)", "map (0..1)"});
  for (const RepeatedStretch& stretch : summary.stretches) {
    const StreamDistance& d = stretch.distance;
    table.add({stretch.name, std::to_string(stretch.recorded.size()), significant(d.event_ratio),
               fixed(d.on_points, 1), fixed(d.gap_decades, 3), fixed(d.rate_variation, 3),
               fixed(d.map_variation, 3)});
  }
  return table;
}

Table fold_table(const CalibrationSummary& summary) {
  Table table{.columns = {{"held out"}}};
  table.add_numeric({"contrast_on", "contrast_off", "refractory [us]", "simulated / recorded",
                     "ON points", "gaps [decades]"});
  for (const HeldOutFold& fold : summary.folds)
    table.add({fmt::format("{}, half {}", fold.recording, fold.fold + 1),
               significant(fold.sensor.contrast_on), significant(fold.sensor.contrast_off),
               significant(fold.sensor.refractory_us), significant(fold.distance.event_ratio),
               fixed(fold.distance.on_points, 1), fixed(fold.distance.gap_decades, 3)});
  return table;
}

void write_calibration_page(const CalibrationSummary& summary, const std::filesystem::path& file) {
  std::string body =
      section("Sensor", table_html(parameter_table(summary.sensor)) + remark_list(summary.remarks));
  if (!summary.stretches.empty())
    body += section("Recorded and simulated", table_html(distance_table(summary)));
  if (!summary.folds.empty())
    body +=
        section("Each half of the time, predicted from the other", table_html(fold_table(summary)));
  for (const RepeatedStretch& stretch : summary.stretches) body += stretch_section(stretch);
  write_atomically(file,
                   page_text({.title = "Calibration of " + summary.sensor.name,
                              .summary = "What a recording tells of its sensor, and how well the "
                                         "simulated sensor repeats it.",
                              .contents = "",
                              .body = body + repeat_html({summary.command}),
                              .definitions = "docs/calibration.md"}));
}

}  // namespace saccade
