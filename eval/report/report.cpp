#include "eval/report/report.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "core/io/files/atomic_file.h"
#include "core/process/parallel.h"
#include "core/process/progress.h"
#include "eval/report/html.h"
#include "eval/report/page.h"
#include "eval/report/report_content.h"
#include "eval/report/sections/page_sections.h"

namespace saccade {
namespace {

std::string dataset_heading(const RunData& data) {
  return fmt::format("<h2>{}</h2>\n", escape_html(data.dataset)) + dataset_pictures(data);
}

std::string framed_section(const RunData& data, const std::string& content, bool packed) {
  return fmt::format("<section id=\"{}\" class=\"run\"><h3>{}</h3>\n", data.id,
                     escape_html(data.run.name())) +
         (packed ? packed_html(content) : content) + "</section>\n";
}

std::string sections(const ReportContent& content, bool film) {
  std::vector<std::pair<const RunData*, bool>> order;  // whether it is a dataset's first
  for (const auto& group : by_dataset(content.runs))
    for (const RunData* data : group) order.emplace_back(data, data == group.front());
  // A page of many runs keeps them compressed: it opens at once.
  const bool packed = content.runs.size() > kMostDetailedRuns;
  std::vector<std::string> parts(order.size());
  // Films show their own progress and are encoded with all threads: one after the other.
  std::optional<Progress> progress;
  if (order.size() > 1 && !film) progress.emplace("drawing", order.size(), "runs");
  const auto draw = [&](std::size_t i) {
    const auto& [data, is_first] = order[i];
    const RunSectionParts shown{content.with_pictures.contains(data), film};
    parts[i] = (is_first ? dataset_heading(*data) : "") +
               framed_section(*data, run_section(*data, shown), packed);
    if (progress) progress->add(1);
  };
  parallel_for(order.size(), draw, film ? order.size() : 1);
  return fmt::format("{}", fmt::join(parts, ""));
}

}  // namespace

void write_report(std::span<const std::filesystem::path> run_folders,
                  const std::filesystem::path& output, const ReportOptions& options) {
  const ReportContent content = gather_report(run_folders, options, RunPages::kTogether);
  write_atomically(output, page_text({.title = options.title,
                                      .summary = content.summary,
                                      .contents = overview_links(content) + run_links(content.runs),
                                      .body = content.overview + sections(content, options.film),
                                      .charts = content.charts}));
  if (!options.exports.empty()) export_tables(content.tables, options.exports);
}

}  // namespace saccade
