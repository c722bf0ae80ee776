#include "core/shell.h"

#include <cctype>

namespace saccade {
namespace {

bool needs_quotes(std::string_view word) {
  constexpr std::string_view kPlain = "_-./=:,+@%";
  for (const char c : word)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 &&
        kPlain.find(c) == std::string_view::npos)
      return true;
  return word.empty();
}

std::string shell_word(std::string_view word) {
  if (!needs_quotes(word)) return std::string(word);
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

}  // namespace

std::string shell_line(std::span<const std::string> words) {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : " ") + shell_word(word);
  return line;
}

std::vector<std::string> shell_words(std::string_view line) {
  std::vector<std::string> words;
  bool in_word = false, in_quotes = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == ' ' && !in_quotes) {
      in_word = false;
      continue;
    }
    if (!in_word) words.emplace_back();
    in_word = true;
    if (line[i] == '\'')
      in_quotes = !in_quotes;
    else if (line[i] == '\\' && !in_quotes && i + 1 < line.size())
      words.back() += line[++i];
    else
      words.back() += line[i];
  }
  return words;
}

}  // namespace saccade
