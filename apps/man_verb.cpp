#include <fmt/core.h>

#include <filesystem>
#include <memory>

#include "apps/manual.h"
#include "apps/verbs.h"
#include "core/io/files/atomic_file.h"

namespace saccade {

void add_man_verb(CLI::App& command) {
  const auto folder = std::make_shared<std::filesystem::path>();
  CLI::App* verb = command.add_subcommand(
      "man", "Write the manual pages of the command and of each verb, from the texts of --help.");
  verb->add_option("-o,--output", *folder, "Folder to write saccade.1, saccade-simulate.1 ... to.")
      ->type_name("DIR")
      ->required();
  verb->footer(
      "Example:\n"
      "  saccade man -o man1 && man -l man1/saccade-simulate.1");
  verb->callback([folder, &command] {
    std::filesystem::create_directories(*folder);
    write_atomically(*folder / "saccade.1", manual_page(command, nullptr));
    for (const CLI::App* one : command.get_subcommands({}))
      write_atomically(*folder / ("saccade-" + one->get_name() + ".1"), manual_page(command, one));
  });
}

}  // namespace saccade
