#include "apps/command_line.h"

#include <cctype>
#include <string_view>

namespace saccade {
namespace {

std::string& line() {
  static std::string text;
  return text;
}

bool needs_quotes(std::string_view word) {
  constexpr std::string_view kPlain = "_-./=:,+@%";
  for (const char c : word)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 &&
        kPlain.find(c) == std::string_view::npos)
      return true;
  return word.empty();
}

std::string quoted(std::string_view word) {
  if (!needs_quotes(word)) return std::string(word);
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

}  // namespace

void set_command_line(int argc, const char* const* argv) {
  line() = "saccade";
  for (int i = 1; i < argc; ++i) line() += " " + quoted(argv[i]);
}

const std::string& command_line() { return line(); }

}  // namespace saccade
