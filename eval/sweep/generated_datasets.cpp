#include "eval/sweep/generated_datasets.h"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "core/check.h"
#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "core/io/files/scratch_folder.h"
#include "core/io/files/sha256.h"
#include "core/process/child_process.h"
#include "core/process/progress.h"
#include "eval/sweep/plan/disk_quota.h"
#include "eval/sweep/plan/generate.h"
#include "eval/sweep/plan/plan.h"
#include "eval/sweep/sweep_folder.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// "random-000417": what a sweep calls its datasets.
bool is_generated_name(const std::string& name) {
  constexpr std::size_t kDigits = 6;
  const std::size_t dash = name.rfind('-');
  return dash != std::string::npos && name.size() - dash - 1 >= kDigits &&
         std::all_of(name.begin() + static_cast<std::ptrdiff_t>(dash) + 1, name.end(),
                     [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// A finished dataset, or the hidden folder of one that was never finished.
bool is_generated_folder(const fs::path& folder) {
  const std::string name = folder.filename().string();
  constexpr std::string_view kUnfinished = ".unfinished";
  if (name.starts_with('.') && name.ends_with(kUnfinished))
    return is_generated_name(name.substr(1, name.size() - 1 - kUnfinished.size()));
  return is_generated_name(name) && fs::exists(folder / "dataset.yaml");
}

std::vector<fs::path> folders_in(const fs::path& parent) {
  std::vector<fs::path> folders;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(parent, error))
    if (entry.is_directory(error) && !entry.is_symlink(error)) folders.push_back(entry.path());
  std::sort(folders.begin(), folders.end());
  return folders;
}

/// Runs a program to its end; InputError with what it printed where it fails.
void run_program(const std::vector<std::string>& words) {
  const ScratchFolder scratch;
  const fs::path log = scratch.path() / "log.txt";
  const InterruptGuard interrupt;
  ChildProcess process(words.front(), words, log);
  std::optional<ChildEnd> end;
  while (!(end = process.poll_end())) {
    pollfd ended{process.descriptor(), POLLIN, 0};
    ::poll(&ended, 1, 200);
    if (interrupt.requested()) throw InputError(words.front(), "was interrupted");
  }
  if (end->exit_code != 0)
    throw InputError(words.front(), "failed with " + end->text() + ": " + text_of(log));
}

/// An archive with the names of its datasets, all in one folder.
struct Archive {
  fs::path folder;
  std::vector<std::string> datasets;
  Json content = Json::array();  ///< the hashes of their dataset.yaml
};

std::map<std::string, Archive> archives_of(const SweepConfig& sweep, const SweepPlan& plan) {
  std::map<std::string, Archive> archives;
  for (std::size_t i = 0; i < plan.simulations.size(); ++i) {
    const SweepJob& job = plan.simulations[i];
    if (!fs::exists(job.output / "dataset.yaml")) continue;
    const GeneratedDataset dataset = generated_dataset(*sweep.generate, sweep.generate->first + i);
    Archive& archive = archives[fmt::format("{}-{:02}", dataset.split, dataset.shard)];
    archive.folder = job.output.parent_path();
    archive.datasets.push_back(job.name);
    archive.content.push_back(
        {{"name", job.name}, {"dataset_yaml_sha256", sha256_of_file(job.output / "dataset.yaml")}});
  }
  return archives;
}

/// Whether the archive is there and was made of these datasets.
bool is_up_to_date(const fs::path& file, const fs::path& record, const Archive& archive) {
  std::error_code error;
  const auto bytes = fs::file_size(file, error);
  if (error || !fs::exists(record)) return false;
  try {
    const Json json = Json::parse(text_of(record));
    return json.at("datasets") == archive.content && json.at("bytes") == bytes;
  } catch (const Json::exception&) {
    return false;
  }
}

void write_archive(const fs::path& file, const fs::path& record, const Archive& archive) {
  const ScratchFolder scratch;
  std::string names;
  for (const std::string& name : archive.datasets) names += name + '\0';
  write_atomically(scratch.path() / "names", names);
  AtomicFile output(file);
  // Nothing but the datasets themselves may decide over the bytes.
  run_program({"tar", "--create", "--file=" + output.path().string(), "--format=ustar",
               "--dereference", "--sort=name", "--mtime=@0", "--owner=0", "--group=0",
               "--numeric-owner", "--mode=u=rwX,go=rX", "--directory=" + archive.folder.string(),
               "--null", "--files-from=" + (scratch.path() / "names").string()});
  const std::string hash = sha256_of_file(output.path());
  const auto bytes = fs::file_size(output.path());
  output.commit();
  write_atomically(record, Json{{"archive", file.filename().string()},
                                {"sha256", hash},
                                {"bytes", bytes},
                                {"datasets", archive.content}}
                                   .dump(1) +
                               "\n");
}

}  // namespace

CleanSummary clean_generated(const SweepConfig& sweep, const fs::path& folder) {
  SACCADE_CHECK(sweep.generate.has_value());
  if (!fs::exists(folder / "sweep.yaml"))
    throw InputError(folder.string(), "holds no sweep (no sweep.yaml) (--clean)");
  const fs::path here = fs::absolute(folder).lexically_normal();
  const SweepFolderLock lock(here);
  std::set<fs::path> planned, planned_records;
  for (const SweepJob& job : plan_sweep(sweep, here).simulations) {
    planned.insert(job.output);
    planned_records.insert(job.name);  // whatever the shard
    // What an interrupted simulation left is gone on with.
    planned.insert(job.output.parent_path() /
                   ("." + job.output.filename().string() + ".unfinished"));
  }
  std::vector<fs::path> candidates = folders_in(here / "data");
  for (const fs::path& shard : folders_in(here / "data"))
    if (shard.filename().string().starts_with("shard-"))
      for (fs::path& dataset : folders_in(shard)) candidates.push_back(std::move(dataset));
  CleanSummary summary;
  for (const fs::path& candidate : candidates) {
    if (planned.contains(candidate) || !is_generated_folder(candidate)) continue;
    summary.bytes += bytes_below(candidate);
    std::error_code error;
    fs::remove_all(candidate, error);
    if (error) throw InputError(candidate.string(), error.message());
    if (!planned_records.contains(candidate.filename()))
      fs::remove_all(here / "jobs" / candidate.filename(), error);
    summary.removed.push_back(candidate);
  }
  return summary;
}

PackSummary pack_generated(const SweepConfig& sweep, const fs::path& folder,
                           const fs::path& output) {
  SACCADE_CHECK(sweep.generate.has_value());
  const fs::path here = fs::absolute(folder).lexically_normal();
  if (!fs::exists(here / "manifest.json"))
    throw InputError(folder.string(),
                     "holds no manifest.json; generate the datasets first (--pack)");
  const SweepFolderLock lock(here);
  const std::map<std::string, Archive> archives = archives_of(sweep, plan_sweep(sweep, here));
  PackSummary summary;
  Progress progress("packing", archives.size(), "archives");
  for (const auto& [name, archive] : archives) {
    const fs::path file = output / (name + ".tar"), record = output / (name + ".json");
    if (is_up_to_date(file, record, archive))
      ++summary.up_to_date;
    else
      write_archive(file, record, archive);
    ++summary.archives;
    summary.datasets += archive.datasets.size();
    progress.add(1);
  }
  write_atomically(output / "manifest.json", text_of(here / "manifest.json"));
  return summary;
}

}  // namespace saccade
