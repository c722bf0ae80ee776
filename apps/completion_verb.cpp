#include <fmt/core.h>

#include <memory>
#include <string>
#include <vector>

#include "apps/completion.h"
#include "apps/verbs.h"

namespace saccade {
namespace {

struct CompletionVerbOptions {
  std::string shell;
  std::vector<std::string> words;
};

}  // namespace

void add_completion_verb(CLI::App& command) {
  const auto options = std::make_shared<CompletionVerbOptions>();
  CLI::App* verb = command.add_subcommand(
      "completion", "Print the completion of this command for a shell: bash, zsh or fish.");
  verb->add_option(
          "SHELL", options->shell,
          "Shell that the script is for. `words` instead prints what the last of WORDS may "
          "become, a line each, which is what the scripts ask for.")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish", "words"}));
  verb->add_option("WORDS", options->words,
                   "Words of a command line behind `saccade`, after `--`; the last may be empty.");
  verb->footer(
      "Examples:\n"
      "  source <(saccade completion bash)\n"
      "  saccade completion zsh > ~/.zfunc/_saccade\n"
      "  saccade completion fish > ~/.config/fish/completions/saccade.fish\n"
      "  saccade completion words -- run tr");
  verb->callback([options, &command] {
    if (options->shell != "words") {
      fmt::print("{}", completion_script(options->shell));
      return;
    }
    for (const Completion& one : complete(command, options->words))
      fmt::print("{}\t{}\n", one.text, one.help);
  });
}

}  // namespace saccade
