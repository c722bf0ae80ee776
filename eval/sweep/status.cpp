#include "eval/sweep/status.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "eval/report/assets.h"
#include "eval/report/html.h"
#include "eval/sweep/plan/plan.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// In the folder of a job, and in that of the sweep.
constexpr const char* kFailedFile = "failed.txt";
constexpr const char* kHeldFile = "held.txt";
constexpr double kRecentS = 600;
constexpr std::size_t kShownFailures = 10;

/// The last line that `saccade` wrote of a failure into a log; empty where there is none.
std::string failure_in(const fs::path& log) {
  constexpr std::string_view kProgram = "saccade: ";
  std::ifstream stream(log);
  std::string message, last;
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with(kProgram)) message = line.substr(kProgram.size());
    if (!line.empty()) last = line;
  }
  // A notice in the middle of a log is no failure: that is the last line of the command.
  return last.starts_with(kProgram) ? message : "";
}

enum class Condition { kDone, kRunning, kFailed, kWaiting };

std::size_t& count_of(JobCounts& counts, Condition condition) {
  switch (condition) {
    case Condition::kDone:
      return counts.done;
    case Condition::kRunning:
      return counts.running;
    case Condition::kFailed:
      return counts.failed;
    case Condition::kWaiting:
      break;
  }
  return counts.waiting;
}

/// Looks at the files of jobs.
class Observer {
 public:
  Observer(const fs::path& folder, SweepStatus& status) : folder_(folder), status_(status) {
    std::ifstream held(folder / kHeldFile);
    for (std::string name; std::getline(held, name);) held_.insert(name);
  }

  void look_at(const std::vector<SweepJob>& jobs, const char* name) {
    for (const SweepJob& job : jobs) {
      if (job.state == JobState::kHeld || held_.contains(job.name)) continue;
      const Condition condition = condition_of(job);
      ++count_of(status_.jobs, condition);
      ++count_of(part(name != nullptr ? name : job.point.configuration), condition);
    }
  }

  void set_rate() {
    if (ages_s_.size() < 2) return;
    const double span_s = *std::max_element(ages_s_.begin(), ages_s_.end());
    if (span_s <= 0) return;
    status_.rate_span_s = span_s;
    status_.jobs_per_s = static_cast<double>(ages_s_.size()) / span_s;
  }

 private:
  JobCounts& part(const std::string& name) {
    for (auto& [known, counts] : status_.parts)
      if (known == name) return counts;
    return status_.parts.emplace_back(name, JobCounts{}).second;
  }

  Condition condition_of(const SweepJob& job) {
    const fs::path job_folder = folder_ / "jobs" / job.name;
    std::error_code none;
    const auto written = fs::last_write_time(job_folder / "job.yaml", none);
    if (!none) {
      const double age_s =
          std::chrono::duration<double>(fs::file_time_type::clock::now() - written).count();
      if (age_s <= kRecentS) ages_s_.push_back(age_s);
      return Condition::kDone;
    }
    std::ifstream mark(job_folder / kFailedFile);
    std::string failure;
    if (!std::getline(mark, failure)) {
      if (!fs::exists(job_folder / "log.txt", none)) return Condition::kWaiting;
      failure = failure_in(job_folder / "log.txt");
    }
    if (failure.empty()) return Condition::kRunning;
    status_.failures.emplace_back(job.name, failure);
    return Condition::kFailed;
  }

  const fs::path& folder_;
  SweepStatus& status_;
  std::set<std::string> held_;  ///< when an earlier program ended
  std::vector<double> ages_s_;  ///< of the records of the last kRecentS
};

std::string rate_text(const SweepStatus& status) {
  if (!status.jobs_per_s) return "";
  std::string text =
      fmt::format("{:.3g} jobs/s over the last {:.0f} s", *status.jobs_per_s, status.rate_span_s);
  if (const auto left = status.left_s()) text += fmt::format(", about {:.0f} s left", *left);
  return text;
}

std::string counts_text(const JobCounts& counts) {
  return fmt::format("{} jobs: {} done, {} running, {} failed, {} waiting", counts.all(),
                     counts.done, counts.running, counts.failed, counts.waiting);
}

/// A bar of what is done, runs and failed.
std::string bar_html(const JobCounts& counts) {
  const double all = std::max<double>(1, static_cast<double>(counts.all()));
  std::string bar;
  for (const auto& [count, colour] :
       {std::pair{counts.done, "--better"}, {counts.running, "--s0"}, {counts.failed, "--worse"}})
    bar += fmt::format("<i style=\"width:{:.2f}%;background:var({})\"></i>",
                       100 * static_cast<double>(count) / all, colour);
  return "<div class=\"stages\" style=\"background:var(--line)\">" + bar + "</div>\n";
}

}  // namespace

void mark_failed(const fs::path& folder, const SweepJob& job) {
  const fs::path file = folder / "jobs" / job.name / kFailedFile;
  std::error_code ignored;
  if (job.failure.empty())
    fs::remove(file, ignored);
  else
    write_atomically(file, job.failure + "\n");
}

void mark_held(const fs::path& folder, const SweepPlan& plan) {
  std::string names;
  for (const auto* jobs : {&plan.simulations, &plan.runs})
    for (const SweepJob& job : *jobs)
      if (job.state == JobState::kHeld) names += job.name + "\n";
  std::error_code ignored;
  if (names.empty())
    fs::remove(folder / kHeldFile, ignored);
  else
    write_atomically(folder / kHeldFile, names);
}

std::optional<double> SweepStatus::left_s() const {
  if (!jobs_per_s || has_ended()) return std::nullopt;
  return static_cast<double>(jobs.running + jobs.waiting) / *jobs_per_s;
}

SweepStatus sweep_status(const SweepPlan& plan, const fs::path& folder) {
  SweepStatus status;
  Observer observer(folder, status);
  observer.look_at(plan.simulations, "datasets");
  observer.look_at(plan.runs, nullptr);
  observer.set_rate();
  return status;
}

SweepStatus sweep_status(const SweepConfig& sweep, const fs::path& folder) {
  if (!fs::exists(folder / "sweep.yaml"))
    throw InputError(folder.string(), "holds no sweep (no sweep.yaml)");
  return sweep_status(plan_sweep(sweep, folder), folder);
}

std::string status_text(const SweepStatus& status) {
  std::string text = counts_text(status.jobs) + "\n";
  if (const std::string rate = rate_text(status); !rate.empty()) text += rate + "\n";
  const std::vector<std::pair<std::string, std::string>>& failed = status.failures;
  for (std::size_t i = 0; i < std::min(failed.size(), kShownFailures); ++i)
    text += fmt::format("failed: {}: {}\n", failed[i].first, failed[i].second);
  if (failed.size() > kShownFailures)
    text += fmt::format("and {} more\n", failed.size() - kShownFailures);
  return text;
}

std::string status_page(const SweepStatus& status, const std::string& title, bool has_ended) {
  std::string body = fmt::format("<h1>{}</h1>\n<p>{}<br>{}</p>\n", escape_html(title),
                                 counts_text(status.jobs), rate_text(status));
  body += bar_html(status.jobs);
  for (const auto& [name, counts] : status.parts)
    body += fmt::format("<h4>{}: {} of {}{}</h4>\n", escape_html(name), counts.done, counts.all(),
                        counts.failed > 0 ? fmt::format(", {} failed", counts.failed) : "") +
            bar_html(counts);
  std::string failed;
  for (std::size_t i = 0; i < std::min(status.failures.size(), kShownFailures); ++i)
    failed +=
        fmt::format("<li><a href=\"jobs/{0}/log.txt\">{0}</a>: {1}</li>\n",
                    escape_html(status.failures[i].first), escape_html(status.failures[i].second));
  if (!failed.empty())
    body += fmt::format("<h2>Failures</h2>\n<p>The first of {}.</p>\n<ul>{}</ul>\n",
                        status.failures.size(), failed);
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">{}"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
      "<meta name=\"color-scheme\" content=\"light dark\"><title>{}</title>\n"
      "<style>\n{}\n</style></head><body>\n<main>{}</main>\n</body></html>\n",
      has_ended ? "" : "<meta http-equiv=\"refresh\" content=\"5\">", escape_html(title),
      assets::report_css, body);
}

std::string sweep_jobs_json(const SweepConfig& sweep, const fs::path& folder) {
  using Json = nlohmann::ordered_json;
  const SweepPlan plan = plan_sweep(sweep, folder);
  std::vector<std::pair<int, Json>> jobs;
  const auto add = [&](const SweepJob& job, const std::vector<SweepJob>& siblings,
                       int first_stage) {
    Json needs = Json::array();
    if (job.made_by) needs.push_back(plan.simulations[*job.made_by].name);
    for (const std::size_t source : job.sources) needs.push_back(siblings[source].name);
    Json one{
        {"name", job.name},
        {"needs", needs},
        {"output", job.output.string()},
        {"scores", job.scores.empty() ? Json(nullptr) : Json(job.scores.string())},
        {"log", (fs::absolute(folder).lexically_normal() / "jobs" / job.name / "log.txt").string()},
        {"commands", job.commands}};
    jobs.emplace_back(first_stage + job.stage, std::move(one));
  };
  for (const SweepJob& job : plan.simulations) add(job, plan.simulations, 0);
  const int stages = SweepPlan::stages(plan.simulations);
  for (const SweepJob& job : plan.runs) add(job, plan.runs, stages);
  std::stable_sort(jobs.begin(), jobs.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  Json list = Json::array();
  for (auto& [stage, job] : jobs) list.push_back(std::move(job));
  return Json{{"folder", fs::absolute(folder).lexically_normal().string()},
              {"threads", sweep.threads},
              {"jobs", list}}
             .dump(1) +
         "\n";
}

}  // namespace saccade
