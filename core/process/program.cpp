#include "core/process/program.h"

#include <fmt/format.h>

#include <system_error>

#include "core/version.h"

namespace saccade {
namespace fs = std::filesystem;

fs::path program_file() { return "/proc/self/exe"; }

std::string program_identity() {
  std::error_code ignored;
  const fs::path program = program_file();
  const auto size = fs::file_size(program, ignored);
  const auto time = fs::last_write_time(program, ignored).time_since_epoch().count();
  return fmt::format("saccade {} ({}), {} bytes of {}", version(), git_commit(), size, time);
}

}  // namespace saccade
