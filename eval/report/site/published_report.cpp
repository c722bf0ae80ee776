#include "eval/report/site/published_report.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <span>
#include <system_error>
#include <tuple>

#include "core/error.h"
#include "core/io/files/folder_name.h"
#include "core/io/files/json_depth.h"
#include "core/io/files/sha256.h"
#include "core/version.h"
#include "eval/evaluate.h"
#include "eval/metrics/catalogue.h"
#include "eval/store/result_row.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kHashDigits = 8;

/// "Nightly: all methods" -> "nightly-all-methods".
std::string address_part(const std::string& title) {
  std::string part;
  for (const char c : title) {
    const auto code = static_cast<unsigned char>(c);
    if (std::isalnum(code) != 0)
      part += static_cast<char>(std::tolower(code));
    else if (!part.empty() && part.back() != '-')
      part += '-';
  }
  while (part.ends_with('-')) part.pop_back();
  return part.empty() ? "report" : part;
}

std::string short_hash_of(const std::string& text) {
  return sha256(std::as_bytes(std::span(text))).substr(0, kHashDigits);
}

std::map<std::string, double> scores_of(const Metrics& metrics) {
  std::map<std::string, double> scores;
  for (const MetricInfo& metric : metric_catalogue()) {
    if (metric.board.empty()) continue;
    const auto value = metric.is_speed ? speed_value(metrics, metric.key) : metrics.get(metric.key);
    if (value) scores[metric.key] = *value;
  }
  return scores;
}

Json run_json(const PublishedRun& run) {
  return {{"run", run.name},      {"page", run.page},       {"method", run.method},
          {"module", run.module}, {"dataset", run.dataset}, {"commit", run.commit},
          {"seed", run.seed},     {"problem", run.problem}, {"scores", run.scores}};
}

PublishedRun run_of(const Json& json) {
  PublishedRun run;
  json.at("run").get_to(run.name);
  json.at("page").get_to(run.page);
  json.at("method").get_to(run.method);
  json.at("module").get_to(run.module);
  json.at("dataset").get_to(run.dataset);
  json.at("commit").get_to(run.commit);
  json.at("seed").get_to(run.seed);
  json.at("problem").get_to(run.problem);
  json.at("scores").get_to(run.scores);
  return run;
}

}  // namespace

PublishedReport published_report(const std::vector<RunData>& runs, const std::string& title) {
  PublishedReport report{"", title, utc_now(), std::string(saccade::version()), {}};
  std::string identity = title + "\n";
  for (const RunData& data : runs) {
    const RunRecord& record = data.run.record;
    report.runs.push_back({.name = data.run.name(),
                           .page = data.address,
                           .method = data.method,
                           .module = record.module,
                           .dataset = data.dataset,
                           .commit = record.commit().empty() ? record.version() : record.commit(),
                           .seed = record.seed,
                           .problem = record.problem(),
                           .scores = scores_of(data.metrics)});
    identity += data.run.name() + "\n" + sha256_of_file(data.run.folder / "run.yaml") + "\n";
  }
  report.name = address_part(title) + "-" + short_hash_of(identity);
  return report;
}

std::string to_json(const PublishedReport& report) {
  Json json{{"title", report.title},
            {"published", report.published},
            {"version", report.version},
            {"runs", Json::array()}};
  for (const PublishedRun& run : report.runs) json["runs"].push_back(run_json(run));
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

PublishedReport read_published_report(const fs::path& folder) {
  const std::string source = (folder / kPublishedScores).string();
  std::ifstream in(source, std::ios::binary);
  if (!in) throw InputError(source, "cannot be read");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  if (json_too_deep_at(text)) throw InputError(source, "is nested too deeply");
  try {
    const Json json = Json::parse(text);
    PublishedReport report;
    report.name = folder_name(folder);
    json.at("title").get_to(report.title);
    json.at("published").get_to(report.published);
    json.at("version").get_to(report.version);
    for (const Json& run : json.at("runs")) report.runs.push_back(run_of(run));
    return report;
  } catch (const Json::exception& error) {
    throw InputError(source, std::string("is no record of a published report: ") + error.what());
  }
}

std::vector<PublishedReport> read_published_reports(const fs::path& site) {
  std::vector<PublishedReport> reports;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(site / "reports", none)) {
    const bool is_hidden = entry.path().filename().string().starts_with('.');  // half written
    if (!is_hidden && fs::exists(entry.path() / kPublishedScores))
      reports.push_back(read_published_report(entry.path()));
  }
  std::sort(reports.begin(), reports.end(), [](const auto& a, const auto& b) {
    return std::tie(a.published, a.name) < std::tie(b.published, b.name);
  });
  return reports;
}

}  // namespace saccade
