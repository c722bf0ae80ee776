#include "apps/manual.h"

#include <fmt/core.h>

#include <sstream>

#include "core/version.h"

namespace saccade {
namespace {

/// Text as groff shows it: a minus that can be copied, and no line that it takes for a request.
std::string troff(const std::string& text) {
  std::string shown;
  for (const char c : text) {
    if (c == '\\')
      shown += "\\e";
    else if (c == '-')
      shown += "\\-";
    else if ((c == '.' || c == '\'') && (shown.empty() || shown.back() == '\n'))
      shown += std::string("\\&") + c;
    else
      shown += c;
  }
  return shown;
}

std::string bold(const std::string& text) { return "\\fB" + troff(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + troff(text) + "\\fR"; }

/// "-o, --output" in bold and what the option takes.
std::string option_head(const CLI::Option& option) {
  if (!option.nonpositional()) return italic(option.get_name(true));
  std::string head;
  for (const std::string& name : option.get_snames())
    head += (head.empty() ? "" : ", ") + bold("-" + name);
  for (const std::string& name : option.get_lnames())
    head += (head.empty() ? "" : ", ") + bold("--" + name);
  return option.get_items_expected_max() > 0 ? head + " " + italic(option.get_type_name()) : head;
}

std::string entry(const std::string& head, const std::string& text) {
  return ".TP\n" + head + "\n" + troff(text) + "\n";
}

std::string option_entries(const CLI::App& app) {
  std::string text;
  for (const bool positional : {true, false})
    for (const CLI::Option* option : app.get_options())
      if (option->nonpositional() != positional && !option->get_group().empty())
        text += entry(option_head(*option), option->get_description());
  return text;
}

std::string synopsis(const CLI::App* verb) {
  if (verb == nullptr)
    return bold("saccade") + " " + italic("VERB") + " [" + italic("OPTIONS") + "]";
  std::string line = bold("saccade " + verb->get_name());
  for (const CLI::Option* option : verb->get_options()) {
    if (option->nonpositional()) continue;
    const std::string name = italic(option->get_name(true));
    const std::string items = option->get_items_expected_max() > 1 ? name + " ..." : name;
    line += option->get_required() ? " " + items : " [" + items + "]";
  }
  return line + " [" + italic("OPTIONS") + "]";
}

/// The footer of the help: examples are indented, the other lines are text.
std::string examples(const std::string& footer) {
  std::string page = ".SH EXAMPLES\n";
  std::istringstream lines(footer);
  bool is_literal = false;
  for (std::string line; std::getline(lines, line);) {
    const bool indented = line.starts_with("  ");
    if (indented != is_literal) page += indented ? ".PP\n.nf\n" : ".fi\n.PP\n";
    is_literal = indented;
    if (line != "Example:" && line != "Examples:") page += troff(line) + "\n";
  }
  return is_literal ? page + ".fi\n" : page;
}

}  // namespace

std::string manual_page(const CLI::App& command, const CLI::App* verb) {
  const CLI::App& app = verb == nullptr ? command : *verb;
  const std::string name = verb == nullptr ? "saccade" : "saccade-" + verb->get_name();
  std::string about = app.get_description();
  while (!about.empty() && about.back() == '\n') about.pop_back();
  if (about.starts_with("saccade: ")) about = about.substr(9);
  std::string page =
      fmt::format(".TH \"{}\" 1 \"\" \"saccade {}\" \"User commands\"\n", name, version());
  page += ".SH NAME\n" + troff(name) + " \\- " + troff(about) + "\n";
  page += ".SH SYNOPSIS\n" + synopsis(verb) + "\n";
  if (verb == nullptr) {
    page += ".SH VERBS\n";
    for (const CLI::App* one : command.get_subcommands({}))
      page += entry(bold(one->get_name()), one->get_description());
  }
  page += ".SH OPTIONS\n" + option_entries(app);
  if (!app.get_footer().empty()) page += examples(app.get_footer());
  if (verb != nullptr) return page + ".SH SEE ALSO\n" + bold("saccade") + "(1)\n";
  page += ".SH SEE ALSO\n";
  std::string others;
  for (const CLI::App* one : command.get_subcommands({}))
    others += (others.empty() ? "" : ", ") + bold("saccade-" + one->get_name()) + "(1)";
  return page + others + "\n";
}

}  // namespace saccade
