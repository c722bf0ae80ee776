#include "eval/sweep/result/dataset_information.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <vector>

#include "core/error.h"
#include "core/io/files/sha256.h"
#include "core/io/tables/csv_file.h"
#include "core/io/tables/csv_reader.h"
#include "core/process/progress.h"
#include "eval/sweep/result/failures.h"
#include "eval/table/number_text.h"
#include "eval/table/table.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFile = "information.csv";
constexpr const char* kVersionColumn = "bounds_version";

struct KnownInformation {
  std::string sha256;
  std::optional<Information> information;  ///< nullopt: the dataset has no truth
};

/// The columns of information.csv after `dataset` and `dataset_yaml_sha256`.
const std::vector<std::pair<const char*, double Information::*>>& columns() {
  static const std::vector<std::pair<const char*, double Information::*>> kColumns{
      {"pose_percent", &Information::pose_percent},
      {"pose_deg", &Information::pose_deg},
      {"path_percent", &Information::path_percent},
      {"own_path_percent", &Information::own_path_percent},
      {"depth_share", &Information::depth_share}};
  return kColumns;
}

using KnownByName = std::map<std::string, KnownInformation>;

KnownByName read_table(const fs::path& file) {
  KnownByName known;
  const CsvColumns table(file);
  const std::size_t version = table.require(kVersionColumn);
  const std::size_t name = table.require("dataset");
  const std::size_t sha256 = table.require("dataset_yaml_sha256");
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (table.number(row, version) != Information::kVersion) continue;
    KnownInformation entry{table.text(row, sha256), std::nullopt};
    if (!table.text(row, table.require(columns().front().first)).empty()) {
      entry.information.emplace();
      for (const auto& [column, member] : columns())
        (*entry.information).*member = table.number(row, table.require(column));
    }
    known.emplace(table.text(row, name), std::move(entry));
  }
  return known;
}

/// By name of the dataset. The file only saves time: one that cannot be read is as good as none.
KnownByName read_known(const fs::path& file) {
  if (!fs::exists(file)) return {};
  try {
    return read_table(file);
  } catch (const InputError& error) {
    show_notice(std::string(error.what()) + "; it is written anew");
    return {};
  }
}

/// nullopt, with a notice, also for a dataset that cannot be read: the page shows the rest.
std::optional<Information> look_at(const SweepJob& job) {
  try {
    return information_of(Dataset::open(job.output));
  } catch (const InputError& error) {
    show_notice(error.what());
    return std::nullopt;
  }
}

void save_known(const KnownByName& known, const fs::path& file) {
  std::vector<std::string> names{"dataset", "dataset_yaml_sha256", kVersionColumn};
  for (const auto& column : columns()) names.emplace_back(column.first);
  CsvTable table(names);
  for (const auto& [name, entry] : known) {
    std::vector<CsvTable::Cell> cells{name, entry.sha256,
                                      static_cast<long long>(Information::kVersion)};
    for (const auto& column : columns())
      if (entry.information)
        cells.emplace_back((*entry.information).*column.second);
      else
        cells.emplace_back(std::string());
    table.add(cells);
  }
  table.save(file);
}

/// Why a dataset is listed: its bound for a module.
std::string bound_text(const Information& information, const std::string& module,
                       bool has_given_start) {
  if (module == "depth")
    return fmt::format("depth of {} % of the edges", rounded(100 * information.depth_share));
  const double percent = module == "track" ? information.pose_percent
                         : has_given_start ? information.path_percent
                                           : information.own_path_percent;
  return fmt::format("{} % of the depth", rounded(percent));
}

/// What a method made of a dataset that tells too little.
std::string answer_text(const SweepRow& row) {
  const std::string status = status_of(row);
  if (row.outcome().has_failed) return status;
  // As long as a person would call a moment.
  constexpr double kMomentS = 0.05;
  const double reported_s = row.metrics.get("trajectory.reported_lost_s").value_or(0);
  const double unreported_s = row.metrics.get("trajectory.loss.unreported_s").value_or(0);
  if (row.metrics.get("success") == 1.0) return "succeeded";
  if (unreported_s > kMomentS)
    return fmt::format("**wrong for {} s, and does not say so**", rounded(unreported_s));
  if (reported_s > 0) return fmt::format("says that it is lost for {} s", rounded(reported_s));
  if (row.metrics.get("depth.points") == 0.0) return "gives none";
  return row.metrics.get("success") ? "**wrong, and does not say so**" : status;
}

bool is_given_start(const SweepRow& row) {
  return !row.method_class || row.method_class->inputs.contains(MethodInput::kStart);
}

}  // namespace

DatasetInformation dataset_information(const SweepPlan& plan, const fs::path& folder) {
  KnownByName known = read_known(folder / kFile);
  DatasetInformation found;
  std::vector<const SweepJob*> due;
  std::map<const SweepJob*, std::string> hashes;
  for (const SweepJob& job : plan.simulations) {
    if (!fs::exists(job.output / job.marker())) continue;
    const std::string sha256 = sha256_of_file(job.output / job.marker());
    const auto before = known.find(job.name);
    if (before == known.end() || before->second.sha256 != sha256) due.push_back(&job);
    hashes[&job] = sha256;
  }
  if (!due.empty()) {
    Progress progress("what the datasets tell at best", due.size(), "datasets");
    for (const SweepJob* job : due) {
      known[job->name] = {hashes[job], look_at(*job)};
      save_known(known, folder / kFile);  // a long sweep may be interrupted
      progress.add(1);
    }
  }
  for (const auto& [job, hash] : hashes)
    if (const auto& information = known[job->name].information)
      found.emplace(job->output, *information);
  return found;
}

std::optional<bool> has_enough(const SweepRow& row) {
  if (!row.information) return std::nullopt;
  return row.information->is_enough_for(row.job->point.module, is_given_start(row));
}

std::string too_little_section(const SweepResults& results) {
  Table table{.columns = {{"dataset"}, {"configuration"}, {"bound"}, {"what became of it"}}};
  std::set<fs::path> datasets;
  for (const SweepRow& row : results.rows) {
    if (has_enough(row).value_or(true)) continue;
    datasets.insert(row.job->dataset);
    table.add({row.job->dataset.filename().string(), row.job->point.configuration,
               bound_text(*row.information, row.job->point.module, is_given_start(row)),
               answer_text(row)});
  }
  if (datasets.empty()) return "";
  return fmt::format(
             "## Too little information\nBy their truth alone {} of the datasets tell too little "
             "for the methods of these rows, which must refuse or say that they are lost "
             "(docs/worlds.md).\n\n",
             datasets.size()) +
         table_markdown(table) + "\n";
}

}  // namespace saccade
