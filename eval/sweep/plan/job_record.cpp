#include "eval/sweep/plan/job_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <system_error>

#include "core/config/config.h"
#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "core/io/files/input_log.h"
#include "core/io/files/sha256.h"
#include "core/process/program.h"
#include "core/process/shell.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using config::Node;

/// Detects a change without reading gigabytes.
std::string size_and_time(const fs::path& file) {
  std::error_code ignored;
  return fmt::format("{} bytes of {}", fs::file_size(file, ignored),
                     fs::last_write_time(file, ignored).time_since_epoch().count());
}

/// Regular files directly in a folder.
std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    if (entry.is_regular_file(error)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

/// The file that a text of a configuration names, if it exists; of "archive!/member" the archive.
fs::path file_named_by(const Node& node) {
  if (node.text.empty() || node.text.size() > 4000 || !node.location.source) return {};
  std::error_code error;
  const fs::path file = node.location.source->folder / node.text.substr(0, node.text.find("!/"));
  return fs::is_regular_file(file, error) ? file.lexically_normal() : fs::path();
}

void add_named_files(const Node& node, bool with_neighbours, Fingerprint& inputs) {
  if (node.kind == Node::Kind::kScalar) {
    const fs::path file = file_named_by(node);
    if (file.empty()) return;
    inputs[file.string()] = sha256_of_file(file);
    if (!with_neighbours) return;
    for (const fs::path& neighbour : files_in(file.parent_path()))
      inputs.emplace(neighbour.string(), size_and_time(neighbour));
  }
  for (const Node& item : node.items) add_named_files(item, with_neighbours, inputs);
  for (const config::Entry& entry : node.entries)
    add_named_files(entry.value, with_neighbours || entry.key == "scene", inputs);
}

/// A recording without a dataset.yaml is identified by its files.
std::string dataset_identity(const fs::path& folder) {
  if (fs::exists(folder / "dataset.yaml")) return sha256_of_file(folder / "dataset.yaml");
  std::string identity;
  for (const fs::path& file : files_in(folder))
    identity += file.filename().string() + ": " + size_and_time(file) + "; ";
  return identity.empty() ? "not there yet" : identity;
}

bool is_complete(const SweepJob& job) {
  return fs::exists(job.output / job.marker()) && (job.scores.empty() || fs::exists(job.scores));
}

}  // namespace

void describe(config::Fields& fields, JobRecord& record) {
  fields.value("commands", record.commands, "Commands that made the output.");
  fields.value("inputs", record.inputs, "Inputs with their hashes.").required();
  fields.value("result_sha256", record.result_sha256, "SHA-256 of dataset.yaml or run.yaml.")
      .required();
  fields.value("wall_s", record.wall_s, "Wall time of all commands, in seconds.");
}

Fingerprint JobInputs::of(const SweepJob& job) {
  Fingerprint inputs;
  if (!job.config.empty()) inputs = configuration(job.config);
  inputs["the program"] = program_identity();
  inputs["the command"] = job.settings;
  if (!job.dataset.empty()) inputs["the dataset"] = dataset(job.dataset);
  for (const fs::path& run : job.source_runs) {
    const fs::path record = run / "run.yaml";
    inputs["the run " + run.filename().string()] =
        fs::exists(record) ? sha256_of_file(record) : "not there yet";
  }
  return inputs;
}

const Fingerprint& JobInputs::configuration(const fs::path& file) {
  const auto known = configurations_.find(file);
  if (known != configurations_.end()) return known->second;
  const InputLog log;
  const config::Document document = config::load(file);
  Fingerprint inputs = log.files();
  add_named_files(document.root(), false, inputs);
  return configurations_.emplace(file, std::move(inputs)).first->second;
}

const std::string& JobInputs::dataset(const fs::path& folder) {
  const auto known = datasets_.find(folder);
  if (known != datasets_.end()) return known->second;
  return datasets_.emplace(folder, dataset_identity(folder)).first->second;
}

std::string identity_of(const Fingerprint& inputs) {
  std::string text;
  for (const auto& [name, content] : inputs) text += name + '\0' + content + '\0';
  return sha256(std::as_bytes(std::span(text)));
}

std::string why_to_run(const SweepJob& job, const fs::path& record_file,
                       const Fingerprint& inputs) {
  if (!fs::exists(record_file)) return "not done yet";
  if (!is_complete(job)) return "its output is gone";
  try {
    const auto record = config::read<JobRecord>(config::load(record_file));
    if (record.result_sha256 != sha256_of_file(job.output / job.marker()))
      return "its output was replaced";
    return difference(record.inputs, inputs);
  } catch (const InputError&) {
    return "its job.yaml is damaged";
  }
}

void write_job_record(const fs::path& file, const SweepJob& job, const Fingerprint& inputs,
                      double wall_s) {
  JobRecord record;
  for (const std::vector<std::string>& command : job.commands) {
    std::vector<std::string> words{"saccade"};
    words.insert(words.end(), command.begin(), command.end());
    record.commands.push_back(shell_line(words));
  }
  record.inputs = inputs;
  record.result_sha256 = sha256_of_file(job.output / job.marker());
  record.wall_s = wall_s;
  write_atomically(file, config::print(record));
}

}  // namespace saccade
