#include "core/io/files/input_log.h"

#include <mutex>

#include "core/check.h"
#include "core/io/files/sha256.h"

namespace saccade {
namespace {

std::mutex mutex;
bool is_open = false;
std::map<std::string, std::string> noted;

bool wants(const std::string& name) {
  const std::scoped_lock lock(mutex);
  return is_open && !noted.contains(name);
}

void keep(const std::string& name, std::string hash) {
  const std::scoped_lock lock(mutex);
  noted.emplace(name, std::move(hash));
}

}  // namespace

InputLog::InputLog() {
  const std::scoped_lock lock(mutex);
  SACCADE_CHECK(!is_open);
  is_open = true;
}

InputLog::~InputLog() {
  const std::scoped_lock lock(mutex);
  is_open = false;
  noted.clear();
}

std::map<std::string, std::string> InputLog::files() const {
  const std::scoped_lock lock(mutex);
  return noted;
}

void InputLog::note(const std::string& name, std::span<const std::byte> bytes) {
  if (wants(name)) keep(name, sha256(bytes));
}

void InputLog::note(const std::filesystem::path& file) {
  if (wants(file.string())) keep(file.string(), sha256_of_file(file));
}

}  // namespace saccade
