#include "eval/sweep/launcher.h"

#include "core/config/suggest.h"
#include "core/error.h"
#include "core/program.h"
#include "eval/sweep/local_launcher.h"

namespace saccade {

std::unique_ptr<Launcher> make_launcher(const std::string& name,
                                        const std::filesystem::path& program) {
  const std::vector<std::string> names{"local"};
  if (name == names[0])
    return std::make_unique<LocalLauncher>(program.empty() ? program_file() : program);
  throw InputError("--launcher", "there is no launcher '" + name + "'; " +
                                     config::suggestion(name, names, "launchers"));
}

}  // namespace saccade
