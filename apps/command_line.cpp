#include "apps/command_line.h"

#include <vector>

#include "core/process/shell.h"

namespace saccade {
namespace {

std::string& line() {
  static std::string text;
  return text;
}

}  // namespace

void set_command_line(int argc, const char* const* argv) {
  std::vector<std::string> words(argv, argv + argc);
  words.front() = "saccade";
  line() = shell_line(words);
}

const std::string& command_line() { return line(); }

}  // namespace saccade
