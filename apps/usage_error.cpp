#include "apps/usage_error.h"

#include <algorithm>

#include "core/config/suggest.h"

namespace saccade {
namespace {

/// The verb that the command line names, or the command itself. Further on the name of a verb is a
/// file or a value.
const CLI::App& stated_verb(const CLI::App& command, const std::vector<std::string>& arguments) {
  for (const CLI::App* verb : command.get_subcommands({}))
    if (!arguments.empty() && arguments[0] == verb->get_name()) return *verb;
  return command;
}

std::vector<std::string> option_names(const CLI::App& verb) {
  std::vector<std::string> names;
  for (const CLI::Option* option : verb.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

std::vector<std::string> verb_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* verb : command.get_subcommands({})) names.push_back(verb->get_name());
  return names;
}

}  // namespace

std::string explain_usage_error(const CLI::App& command, const CLI::ParseError& error,
                                const std::vector<std::string>& arguments) {
  const CLI::App& verb = stated_verb(command, arguments);
  const bool has_verb = &verb != &command;
  const std::string help =
      has_verb ? "\nTry: saccade " + verb.get_name() + " --help" : "\nTry: saccade --help";
  if (!has_verb && !arguments.empty() && arguments[0][0] != '-')
    return "unknown verb '" + arguments[0] + "'; " +
           config::suggestion(arguments[0], verb_names(command), "verbs") + help;
  for (const std::string& argument : arguments) {
    const std::string name = argument.substr(0, argument.find('='));
    const std::vector<std::string> names = option_names(verb);
    if (name.starts_with("--") && std::find(names.begin(), names.end(), name) == names.end())
      return "unknown option '" + name + "'; " + config::suggestion(name, names, "options") + help;
  }
  return error.what() + help;
}

}  // namespace saccade
