#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "core/io/files/atomic_file.h"

namespace saccade {

/// What a piece of work depends on: a name ("configuration", "scene.obj") -> its content or hash.
using Fingerprint = std::map<std::string, std::string>;

/// "the configuration differs" or "scene.obj is not used any more"; empty where the two agree.
[[nodiscard]] std::string difference(const Fingerprint& before, const Fingerprint& now);

/// An output folder that appears under its final name only when it is complete, and whose
/// unfinished state outlives a program that is killed: it grows in the hidden sibling
/// `.NAME.unfinished`, which is found again by the next program with the same fingerprint.
/// Leftovers of another fingerprint, and damaged ones, are removed. A lock keeps two programs from
/// writing the same folder. An exception that passes the folder removes everything; only a killed
/// program leaves something behind.
class ResumableFolder {
 public:
  /// As AtomicFolder; InputError also when another program is writing the same folder.
  ResumableFolder(const std::filesystem::path& folder, std::string marker,
                  const Fingerprint& fingerprint);
  ~ResumableFolder();
  ResumableFolder(const ResumableFolder&) = delete;
  ResumableFolder& operator=(const ResumableFolder&) = delete;

  /// Where to write until commit(). Files whose writing was cut short are not in it any more.
  [[nodiscard]] std::filesystem::path path() const;
  /// A folder for what is needed to go on: not a part of the result.
  [[nodiscard]] std::filesystem::path journal() const;
  /// The final name.
  [[nodiscard]] const std::filesystem::path& target() const { return final_.path(); }

  /// True when there is an earlier program's work to go on with.
  [[nodiscard]] bool is_resumed() const { return is_resumed_; }
  /// Why an earlier program's work was thrown away; empty when there was none or it is used.
  [[nodiscard]] const std::string& refusal() const { return refusal_; }

  /// Throws away all that was written, because of `why`, which refusal() then says.
  void start_clean(const std::string& why);

  /// Gives the folder its final name. Once; path() and journal() are gone afterwards.
  void commit();

  /// Whether this program is at work on such a folder: one that is killed now can be gone on with.
  [[nodiscard]] static bool is_any_unfinished();

 private:
  class Lock;
  void take_up_leftovers();
  void clear();

  FinalFolder final_;
  std::filesystem::path workplace_;
  Fingerprint fingerprint_;
  bool is_resumed_ = false;
  bool committed_ = false;
  std::string refusal_;
  std::unique_ptr<Lock> lock_;
};

}  // namespace saccade
