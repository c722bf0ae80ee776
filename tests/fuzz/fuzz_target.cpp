#include "tests/fuzz/fuzz_target.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>

#include "core/error.h"
#include "core/process/progress.h"
#include "core/refused_path.h"

namespace saccade::fuzz {

const Target& find_target(const std::string& name) {
  std::string names;
  for (const Target& target : targets()) {
    if (target.name == name) return target;
    names += " " + target.name;
  }
  throw InputError(name, "is no fuzz target of this program; these are:" + names);
}

Feeder::Feeder(const Target& target) : target_(target) {
  set_progress_quiet(true);
  target_.write_files(folder_.path());
  for (const std::string& file : target_.files) valid_.push_back(read_bytes(folder_.path() / file));
}

bool Feeder::accepts(std::string_view input) {
  const bool chooses = target_.files.size() > 1;
  if (chooses && input.empty()) return false;
  const std::size_t chosen =
      chooses ? static_cast<unsigned char>(input.front()) % target_.files.size() : 0;
  if (spoilt_ != chosen) write_bytes(folder_.path() / target_.files[spoilt_], valid_[spoilt_]);
  spoilt_ = chosen;
  write_bytes(folder_.path() / target_.files[chosen], input.substr(chooses ? 1 : 0));
  try {
    target_.decode(folder_.path(), target_.files[chosen]);
    return true;
  } catch (const InputError& error) {
    refusal_ = error.what();
    return false;
  } catch (const std::filesystem::filesystem_error& error) {
    const auto refusal = refused_path(error);
    if (!refusal) throw;
    refusal_ = refusal->what();
    return false;
  }
}

std::vector<std::string> Feeder::seeds() const {
  std::vector<std::string> inputs;
  for (std::size_t i = 0; i < valid_.size(); ++i)
    inputs.push_back((valid_.size() > 1 ? std::string(1, static_cast<char>(i)) : "") + valid_[i]);
  return inputs;
}

std::string dictionary(const Target& target) {
  std::string text = "# words of " + target.name + "\n";
  for (const std::string& word : target.words) {
    text += '"';
    for (const char c : word)
      text += c >= ' ' && c <= '~' && c != '"' && c != '\\'
                  ? std::string(1, c)
                  : fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    text += "\"\n";
  }
  return text;
}

void write_bytes(const std::filesystem::path& file, std::string_view bytes) {
  std::ofstream(file, std::ios::binary | std::ios::trunc)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

std::string read_bytes(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(file.string(), "cannot be opened");
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace saccade::fuzz
