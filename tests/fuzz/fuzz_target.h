#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/files/scratch_folder.h"

namespace saccade::fuzz {

/// A reader that must take any bytes: with a result or an InputError, and nothing else.
struct Target {
  std::string name;  ///< of the folder of its reproducers, too
  /// What the bytes are written to, relative to a scratch folder. Of several the first byte of an
  /// input chooses one, and the others stay as `write_seeds` left them.
  std::vector<std::string> files;
  /// Reads the file that was replaced, with what stands around it in the folder.
  void (*decode)(const std::filesystem::path& folder, const std::string& file);
  /// Writes valid content to the files, by the writers of this program where it has any.
  void (*write_files)(const std::filesystem::path& folder);
  /// Words of the format, for the dictionary.
  std::vector<std::string> words;
};

/// The table of a program: each room has its own.
[[nodiscard]] const std::vector<Target>& targets();
/// InputError that lists the targets where there is none of this name.
[[nodiscard]] const Target& find_target(const std::string& name);

/// Feeds inputs to a target.
class Feeder {
 public:
  explicit Feeder(const Target& target);

  /// Whether the input was accepted; false after an InputError. Everything else passes through.
  bool accepts(std::string_view input);
  /// What the reader says of the last input that it refused.
  [[nodiscard]] const std::string& refusal() const { return refusal_; }
  /// The valid inputs that the target's own files make, one for each.
  [[nodiscard]] std::vector<std::string> seeds() const;

 private:
  const Target& target_;
  ScratchFolder folder_;
  std::vector<std::string> valid_;  ///< content of each file
  std::size_t spoilt_ = 0;          ///< the file that the last input replaced
  std::string refusal_;
};

/// The words as libFuzzer's dictionaries have them, one a line.
[[nodiscard]] std::string dictionary(const Target& target);

void write_bytes(const std::filesystem::path& file, std::string_view bytes);
[[nodiscard]] std::string read_bytes(const std::filesystem::path& file);

}  // namespace saccade::fuzz
