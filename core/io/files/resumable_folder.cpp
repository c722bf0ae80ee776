#include "core/io/files/resumable_folder.h"

#include <atomic>
#include <optional>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/check.h"
#include "core/config/config.h"
#include "core/error.h"
#include "core/io/files/file_bytes.h"
#include "core/io/files/file_lock.h"
#include "core/io/files/sha256.h"
#include "core/io/files/unfinished_sibling.h"

namespace saccade {
namespace fs = std::filesystem;
namespace {

std::atomic<int> unfinished_folders = 0;

constexpr const char* kLockFile = "lock";
constexpr const char* kContent = "content";
constexpr const char* kJournal = "journal";
constexpr const char* kInputsFile = "inputs.yaml";
/// Stands beside the content while that is being given its name, with the hash of its marker.
constexpr const char* kCompleteFile = "complete";

/// The contents of inputs.yaml.
void describe_inputs(config::Fields& fields, Fingerprint& inputs) {
  fields.value("inputs", inputs, "What the unfinished work depends on.");
}

void create_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(folder.string(), "cannot be created: " + error.message());
}

/// Files that their writer had not renamed yet.
void remove_half_written(const fs::path& folder) {
  std::vector<fs::path> partial;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with('.') && name.find(".partial-") != std::string::npos)
      partial.push_back(entry.path());
  }
  for (const fs::path& file : partial) fs::remove(file);
}

/// All of a workplace, the lock last, so that a kill in between leaves something recognisable.
void remove_workplace(const fs::path& folder) {
  std::error_code ignored;
  std::vector<fs::path> entries;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored))
    if (entry.path().filename() != kLockFile) entries.push_back(entry.path());
  for (const fs::path& entry : entries) fs::remove_all(entry, ignored);
  fs::remove_all(folder, ignored);
}

/// Whether there is nothing but what this class makes. The lock may be gone: a program whose
/// workplace was removed may have made a part of it anew.
bool may_be_workplace(const fs::path& folder) {
  if (fs::exists(folder / kLockFile)) return true;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name != kContent && name != kJournal && name != kInputsFile && name != kCompleteFile)
      return false;
  }
  return !error;
}

}  // namespace

std::string difference(const Fingerprint& before, const Fingerprint& now) {
  for (const auto& [name, content] : now) {
    const auto it = before.find(name);
    if (it == before.end() || it->second != content) return name + " differs";
  }
  for (const auto& [name, content] : before)
    if (!now.contains(name)) return name + " is not used any more";
  return {};
}

/// `folder` is created when it is not there.
class ResumableFolder::Lock {
 public:
  Lock(const fs::path& folder, const fs::path& target)
      : lock_(FileLock::try_take(folder / kLockFile)) {
    if (!lock_)
      throw InputError(target.string(), "is being written by another program at this moment");
  }

 private:
  std::optional<FileLock> lock_;
};

ResumableFolder::ResumableFolder(const fs::path& folder, std::string marker,
                                 const Fingerprint& fingerprint)
    : final_(folder, std::move(marker)), fingerprint_(fingerprint) {
  final_.check_replaceable();
  final_.create_parent();
  remove_abandoned_siblings(target().parent_path());
  workplace_ = target().parent_path() / ("." + target().filename().string() + ".unfinished");
  if (fs::exists(workplace_) && !may_be_workplace(workplace_))
    throw InputError(workplace_.string(), "is in the way: remove it or choose another output");
  try {
    lock_ = std::make_unique<Lock>(workplace_, target());
  } catch (const std::exception&) {
    // The folder that was made for a lock that cannot be taken; one that holds anything stays.
    std::error_code ignored;
    fs::remove(workplace_, ignored);
    throw;
  }
  try {
    take_up_leftovers();
  } catch (const std::exception&) {
    remove_workplace(workplace_);
    throw;
  }
  ++unfinished_folders;
}

ResumableFolder::~ResumableFolder() {
  --unfinished_folders;
  if (!committed_) remove_workplace(workplace_);
}

fs::path ResumableFolder::path() const { return workplace_ / kContent; }
fs::path ResumableFolder::journal() const { return workplace_ / kJournal; }

bool ResumableFolder::is_any_unfinished() { return unfinished_folders > 0; }

void ResumableFolder::take_up_leftovers() {
  if (!fs::exists(workplace_ / kInputsFile)) return clear();  // new, or not even begun
  try {
    Fingerprint before;
    config::Session::read(config::load(workplace_ / kInputsFile),
                          [&](config::Fields& fields) { describe_inputs(fields, before); }, {});
    refusal_ = difference(before, fingerprint_);
  } catch (const InputError&) {
    refusal_ = "its list of inputs is damaged";
  }
  if (refusal_.empty() && !(fs::is_directory(path()) && fs::is_directory(journal())))
    refusal_ = "a part of it is missing";
  if (!refusal_.empty()) return clear();
  const fs::path complete = workplace_ / kCompleteFile;
  const fs::path result = path() / final_.marker();
  if (fs::exists(complete)) {
    // The content may be the folder that the complete one replaced.
    const std::vector<std::byte> stated = read_file_bytes(complete);
    const std::string hash = fs::exists(result) ? sha256_of_file(result) : "";
    if (std::string_view(reinterpret_cast<const char*>(stated.data()), stated.size()) != hash)
      return clear();
    fs::remove(complete);
  }
  remove_half_written(path());
  remove_half_written(journal());
  is_resumed_ = true;
}

void ResumableFolder::clear() {
  for (const char* old : {kInputsFile, kCompleteFile}) fs::remove(workplace_ / old);
  for (const fs::path& old : {path(), journal()}) {
    fs::remove_all(old);
    create_folder(old);
  }
  write_atomically(workplace_ / kInputsFile,
                   config::to_yaml(config::Session::write(
                       [&](config::Fields& fields) { describe_inputs(fields, fingerprint_); })));
}

void ResumableFolder::start_clean(const std::string& why) {
  is_resumed_ = false;
  refusal_ = why;
  clear();
}

void ResumableFolder::commit() {
  SACCADE_CHECK(!committed_);
  // Files are written into a folder that is made anew where it is gone: a half would be left.
  for (const char* file : {kLockFile, kInputsFile})
    if (!fs::exists(workplace_ / file))
      throw InputError(workplace_.string(), "was removed by someone else while it was written");
  write_atomically(workplace_ / kCompleteFile, sha256_of_file(path() / final_.marker()));
  final_.take(path());
  committed_ = true;
  remove_workplace(workplace_);
}

}  // namespace saccade
