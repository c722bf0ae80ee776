#include "eval/sweep/launch/launcher.h"

#include "core/config/suggest.h"
#include "core/error.h"
#include "core/process/program.h"
#include "eval/sweep/launch/local_launcher.h"
#include "eval/sweep/launch/slurm_launcher.h"

namespace saccade {

std::unique_ptr<Launcher> make_launcher(const std::string& name, LauncherOptions options) {
  const std::vector<std::string> names{"local", "slurm"};
  if (options.program.empty()) options.program = program_file();
  if (name == names[0]) return std::make_unique<LocalLauncher>(options.program);
  if (name == names[1])
    return std::make_unique<SlurmLauncher>(options, std::make_unique<SlurmCommands>());
  throw InputError("--launcher", "there is no launcher '" + name + "'; " +
                                     config::suggestion(name, names, "launchers"));
}

}  // namespace saccade
