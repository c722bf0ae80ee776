#include "eval/report/site/publish.h"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "core/io/files/file_lock.h"
#include "core/process/parallel.h"
#include "core/process/progress.h"
#include "eval/report/html.h"
#include "eval/report/page.h"
#include "eval/report/report_content.h"
#include "eval/report/sections/page_sections.h"
#include "eval/report/site/published_report.h"
#include "eval/report/site/site_pages.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// Lies in every site: in no other folder are pages replaced or removed.
constexpr const char* kMarker = "saccade_site.json";
/// From the page of a report, and from that of a run.
constexpr const char* kFromReport = "../../assets";
constexpr const char* kFromRun = "../../../assets";

/// A folder with other contents is left alone.
void check_site(const fs::path& site) {
  if (!fs::exists(site)) return;
  if (!fs::is_directory(site)) throw InputError(site.string(), "is not a folder (--publish)");
  if (!fs::is_empty(site) && !fs::exists(site / kMarker))
    throw InputError(site.string(),
                     fmt::format("is not empty and no site of reports (no {} in it); choose "
                                 "another folder (--publish)",
                                 kMarker));
}

std::string run_page(const RunData& data, const std::string& title, const RunSectionParts& parts) {
  return page_text({.title = data.run.name(),
                    .summary = fmt::format("{} on {}. <a href=\"../index.html#{}\">{}</a>",
                                           escape_html(data.method), escape_html(data.dataset),
                                           data.id, escape_html(title)),
                    .contents = "",
                    .body = fmt::format("<section class=\"run\" id=\"{}\">", data.id) +
                            run_section(data, parts) + "</section>\n",
                    .assets = kFromRun});
}

/// Of every dataset what is in its events, and the runs over it.
std::string dataset_sections(const ReportContent& content) {
  std::string html;
  for (const auto& group : by_dataset(content.runs)) {
    html += fmt::format("<section><h2>{}</h2>\n", escape_html(group.front()->dataset)) +
            dataset_pictures(*group.front()) + "<nav>";
    for (const RunData* data : group)
      html += fmt::format("<a id=\"{}\" href=\"{}\">{}</a>", data->id, escape_html(data->address),
                          escape_html(data->run.name()));
    html += "</nav></section>\n";
  }
  return html;
}

void write_run_pages(const ReportContent& content, const ReportOptions& options,
                     const fs::path& folder) {
  std::optional<Progress> progress;
  if (content.runs.size() > 1 && !options.film)
    progress.emplace("drawing", content.runs.size(), "runs");
  const auto write = [&](std::size_t i) {
    const RunData& data = content.runs[i];
    write_atomically(
        folder / data.address,
        run_page(data, options.title, {content.with_pictures.contains(&data), options.film}));
    if (progress) progress->add(1);
  };
  // Films show their own progress and are encoded with all threads: one after the other.
  parallel_for(content.runs.size(), write, options.film ? content.runs.size() : 1);
}

void write_report_folder(const ReportContent& content, const PublishedReport& report,
                         const ReportOptions& options, const fs::path& folder) {
  AtomicFolder output(folder, std::string(kPublishedScores));
  write_run_pages(content, options, output.path());
  write_atomically(
      output.path() / "index.html",
      page_text({.title = options.title,
                 .summary = content.summary + " <a href=\"../../index.html\">All reports</a>",
                 .contents = overview_links(content) + run_links(content.runs),
                 .body = content.overview + dataset_sections(content),
                 .charts = content.charts,
                 .assets = kFromReport}));
  write_atomically(output.path() / kPublishedScores, to_json(report));
  output.commit();
}

/// Pages of methods that no report has any more.
void remove_other_pages(const fs::path& folder, const std::map<std::string, std::string>& files) {
  std::set<std::string> kept;
  for (const auto& [method, file] : files) kept.insert(file);
  std::error_code ignored;
  std::vector<fs::path> others;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored))
    if (entry.path().extension() == ".html" && !kept.contains(entry.path().filename().string()))
      others.push_back(entry.path());
  for (const fs::path& other : others) fs::remove(other, ignored);
}

void write_site_pages(const fs::path& site) {
  const std::vector<PublishedReport> reports = read_published_reports(site);
  const std::map<std::string, std::string> files = method_files(reports);
  for (const auto& [method, file] : files)
    write_atomically(site / "methods" / file, method_page(method, reports));
  remove_other_pages(site / "methods", files);
  write_atomically(site / "assets" / "runs.js", search_script(reports));
  write_atomically(site / "index.html", site_index(reports));
}

}  // namespace

fs::path publish_report(std::span<const fs::path> run_folders, const fs::path& site,
                        const ReportOptions& options) {
  check_site(site);
  const ReportContent content = gather_report(run_folders, options, RunPages::kApart);
  const PublishedReport report = published_report(content.runs, options.title);
  const fs::path folder = site / "reports" / report.name;
  fs::create_directories(site / "reports");
  const FileLock lock = FileLock::wait_for(site / "reports" / ".lock");
  // One that cannot be read is said before anything is written.
  static_cast<void>(read_published_reports(site));
  write_atomically(site / kMarker, "{\"format_version\": 1}\n");
  for (const PageAsset& asset : page_assets())
    write_atomically(site / "assets" / asset.name, asset.text);
  write_report_folder(content, report, options, folder);
  write_site_pages(site);
  std::error_code ignored;
  fs::remove(site / "reports" / ".lock", ignored);
  if (!options.exports.empty()) export_tables(content.tables, options.exports);
  return folder / "index.html";
}

}  // namespace saccade
