#include <fcntl.h>
#include <fmt/core.h>
#include <spawn.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "apps/common_options.h"
#include "apps/option_checks.h"
#include "apps/verbs.h"
#include "apps/view_server.h"
#include "core/error.h"
#include "eval/view/view_clip.h"
#include "eval/view/view_session.h"
#include "simulator/event_log.h"
#include "simulator/resume.h"

namespace saccade {
namespace {

struct ViewVerbOptions {
  std::vector<std::filesystem::path> paths;
  std::filesystem::path output;  ///< of --export
  int port = 0;
  bool has_port = false;
  bool no_browser = false;
  CommonOptions common;
};

/// Asks the desktop to open the page. Without one nothing happens: the URL is on the terminal.
void open_browser(const std::string& url) {
  if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return;
  std::string program = "xdg-open", argument = url;
  char* const arguments[] = {program.data(), argument.data(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  posix_spawnp(&child, program.c_str(), &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
}

void write_page(const ViewVerbOptions& options) {
  if (options.has_port || options.no_browser)
    throw InputError(options.has_port ? "--port" : "--no-browser",
                     "is for a page that is served; --export writes a file");
  ViewSession session(options.paths);
  const std::string summary = write_clip(session, options.output);
  if (!options.common.quiet) fmt::print("wrote {}: {}\n", options.output.string(), summary);
}

/// The events of a simulation that is still running, by the journal of its first camera.
EventTail simulated_events(const std::filesystem::path& hidden) {
  const auto tail = std::make_shared<EventLogTail>(event_log_folder(hidden / "journal", 0));
  return [tail](Events& events) { tail->read(events); };
}

void serve(const ViewVerbOptions& options) {
  ViewSession session(options.paths, simulated_events);
  ViewServer server(session, options.port);
  server.run([&] {
    fmt::print("{}\n", server.url());
    std::fflush(stdout);
    if (!options.no_browser) open_browser(server.url());
  });
  if (!options.common.quiet) fmt::print("ended\n");
}

void view(const ViewVerbOptions& options) {
  options.common.apply();
  if (options.output.empty())
    serve(options);
  else
    write_page(options);
}

}  // namespace

void add_view_verb(CLI::App& command) {
  const auto options = std::make_shared<ViewVerbOptions>();
  CLI::App* verb = command.add_subcommand(
      "view",
      "Show datasets and runs on a page in the browser: events, frames, depth, images, paths in "
      "3-D and errors, played together. Prints the page's URL and serves it until Ctrl-C.");
  verb->add_option("PATH", options->paths,
                   "Dataset or run folders; also one that another program is still writing.")
      ->required();
  CLI::Option* port =
      verb->add_option("--port", options->port, "Port on 127.0.0.1 (default: a free one).")
          ->type_name("N")
          ->check(whole_number(1, 65535));
  verb->add_flag("--no-browser", options->no_browser, "Do not open a browser.");
  verb->add_option("--export", options->output,
                   "Write one self-contained page with a part of the data instead.")
      ->type_name("FILE");
  add_common_options(*verb, options->common);
  verb->footer(
      "Examples:\n"
      "  saccade view data/walls\n"
      "  saccade view runs/walls_fast runs/walls_best --port 8080 --no-browser\n"
      "  saccade view runs/walls --export walls.html");
  verb->callback([options, port] {
    options->has_port = port->count() > 0;
    view(*options);
  });
}

}  // namespace saccade
