#include "apps/completion.h"

#include <algorithm>

#include "apps/reference_page.h"
#include "core/config/shipped.h"
#include "core/error.h"
#include "estimator/registry.h"

namespace saccade {
namespace {

std::string first_sentence(const std::string& text) {
  const std::string line = text.substr(0, text.find('\n'));
  const std::size_t end = line.find(". ");
  return end == std::string::npos ? line : line.substr(0, end + 1);
}

const CLI::App* find_verb(const CLI::App& command, const std::string& name) {
  for (const CLI::App* verb : command.get_subcommands({}))
    if (verb->get_name() == name) return verb;
  return nullptr;
}

bool takes_value(const CLI::Option& option) {
  return option.nonpositional() && option.get_items_expected_max() > 0;
}

/// The option of a verb that is written like this; nullptr where there is none.
const CLI::Option* find_option(const CLI::App& verb, const std::string& word) {
  if (!word.starts_with('-')) return nullptr;
  for (const CLI::Option* option : verb.get_options())
    if (option->check_name(word)) return option;
  return nullptr;
}

void add_options(const CLI::App& app, std::vector<Completion>& found) {
  for (const CLI::Option* option : app.get_options()) {
    const std::string help = first_sentence(option->get_description());
    for (const std::string& name : option->get_lnames()) found.push_back({"--" + name, help});
    if (option->get_lnames().empty())
      for (const std::string& name : option->get_snames()) found.push_back({"-" + name, help});
  }
}

/// The choices of an option, as its check names them: "{us,ns}" in the name of its type.
std::vector<Completion> choices_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t open = type.find('{');
  const std::size_t close = type.find('}', open);
  std::vector<Completion> found;
  if (open == std::string::npos || close == std::string::npos) return found;
  for (std::size_t i = open + 1; i < close;) {
    const std::size_t end = std::min(type.find(',', i), close);
    found.push_back({type.substr(i, end - i), ""});
    i = end + 1;
  }
  return found;
}

/// Words that stand for themselves: neither options nor their values.
std::vector<std::string> positionals(const CLI::App& verb, const std::vector<std::string>& words) {
  std::vector<std::string> found;
  for (std::size_t i = 1; i + 1 < words.size(); ++i) {
    const CLI::Option* option = find_option(verb, words[i]);
    if (option != nullptr && takes_value(*option)) ++i;
    if (option == nullptr && !words[i].starts_with('-')) found.push_back(words[i]);
  }
  return found;
}

/// The folder of configs/ with those of a module, whose name begins like that of the module
/// ("track", "tracking").
std::vector<Completion> configurations_of(const std::string& subject) {
  constexpr std::size_t kStem = 5;
  std::vector<Completion> found;
  for (const std::string& name : config::shipped_configurations())
    if (name.starts_with(subject.substr(0, kStem))) found.push_back({name, ""});
  return found;
}

/// Keys of the configuration of `verb`, for --set.
std::vector<Completion> keys_of(const std::string& verb, const std::vector<std::string>& stated) {
  std::string page = verb;
  if (verb == "run") page = stated.empty() ? "" : stated.front();
  const std::vector<std::string> pages = reference_page_names();
  std::vector<Completion> found;
  if (std::find(pages.begin(), pages.end(), page) == pages.end()) return found;
  for (const config::ReferenceKey& key : reference_page(page).keys)
    if (key.type != "section" && key.name.find("[]") == std::string::npos)
      found.push_back({key.name + "=", first_sentence(key.help)});
  return found;
}

std::vector<Completion> value_of(const CLI::App& verb, const CLI::Option& option,
                                 const std::vector<std::string>& stated) {
  if (option.check_name("--set")) return keys_of(verb.get_name(), stated);
  if (option.check_name("-c") && verb.get_name() == "run" && !stated.empty())
    return configurations_of(stated.front());
  return choices_of(option);
}

std::vector<Completion> positional_of(const CLI::App& verb,
                                      const std::vector<std::string>& stated) {
  std::vector<Completion> found;
  if (verb.get_name() == "run" && stated.empty())
    for (const Module& module : modules())
      found.push_back({module.name, first_sentence(module.help)});
  if (stated.empty() && (verb.get_name() == "simulate" || verb.get_name() == "sweep"))
    return configurations_of(verb.get_name());
  std::size_t index = 0;
  for (const CLI::Option* option : verb.get_options())
    if (!option->nonpositional() && index++ == stated.size() && found.empty())
      found = choices_of(*option);
  return found;
}

std::vector<Completion> candidates(const CLI::App& command, const std::vector<std::string>& words) {
  std::vector<Completion> found;
  if (words.size() == 1) {
    for (const CLI::App* verb : command.get_subcommands({}))
      found.push_back({verb->get_name(), first_sentence(verb->get_description())});
    add_options(command, found);
    return found;
  }
  const CLI::App* verb = find_verb(command, words.front());
  if (verb == nullptr) return found;
  const CLI::Option* before = find_option(*verb, words[words.size() - 2]);
  const std::vector<std::string> stated = positionals(*verb, words);
  if (words.size() > 2 && before != nullptr && takes_value(*before))
    return value_of(*verb, *before, stated);
  if (words.back().starts_with('-')) {
    add_options(*verb, found);
    return found;
  }
  return positional_of(*verb, stated);
}

constexpr const char* kBash = R"(# bash completion for saccade, by `saccade completion bash`
_saccade() {
  local cur=${COMP_WORDS[COMP_CWORD]} line
  COMPREPLY=()
  while IFS=$'\t' read -r line _; do COMPREPLY+=("$line"); done \
    < <("${COMP_WORDS[0]}" completion words -- "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null)
  if [[ ${#COMPREPLY[@]} -eq 0 ]]; then
    compopt -o default
  elif [[ ${#COMPREPLY[@]} -eq 1 && ${COMPREPLY[0]} == *= ]]; then
    compopt -o nospace
  fi
}
complete -F _saccade saccade
)";

constexpr const char* kZsh = R"(#compdef saccade
# zsh completion for saccade, by `saccade completion zsh`
_saccade() {
  local -a found
  local word help
  while IFS=$'\t' read -r word help; do
    found+=("${word//:/\\:}:$help")
  done < <("${words[1]}" completion words -- "${(@)words[2,CURRENT]}" 2>/dev/null)
  if (( ${#found} )); then
    _describe saccade found
  else
    _files
  fi
}
if [[ $funcstack[1] == _saccade ]]; then
  _saccade "$@"
else
  compdef _saccade saccade
fi
)";

constexpr const char* kFish = R"(# fish completion for saccade, by `saccade completion fish`
function __saccade_complete
    set -l words (commandline -opc) (commandline -ct)
    set -l found ($words[1] completion words -- $words[2..-1] 2>/dev/null)
    if test (count $found) -gt 0
        printf '%s\n' $found
    else
        __fish_complete_path (commandline -ct)
    end
end
complete -c saccade -f -a '(__saccade_complete)'
)";

}  // namespace

std::vector<Completion> complete(const CLI::App& command, const std::vector<std::string>& words) {
  if (words.empty()) return {};
  std::vector<Completion> found = candidates(command, words);
  std::erase_if(found, [&](const Completion& one) { return !one.text.starts_with(words.back()); });
  return found;
}

std::string completion_script(const std::string& shell) {
  if (shell == "bash") return kBash;
  if (shell == "zsh") return kZsh;
  if (shell == "fish") return kFish;
  throw InputError("SHELL", "must be bash, zsh or fish, not '" + shell + "'");
}

}  // namespace saccade
