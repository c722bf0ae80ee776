#include "core/io/files/scratch_folder.h"

#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>

#include "core/error.h"
#include "core/io/files/atomic_file.h"

namespace saccade {

namespace fs = std::filesystem;

namespace {

fs::path make_scratch_folder() {
  std::error_code error;
  const fs::path parent = fs::temp_directory_path(error);
  if (error) {
    const char* wanted = std::getenv("TMPDIR");
    throw InputError(wanted ? wanted : "/tmp",
                     "the folder for temporary files: " + error.message() + "; set TMPDIR");
  }
  std::string name = (parent / "saccade_XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) fail_to_write(parent, errno);
  return name;
}

}  // namespace

ScratchFolder::ScratchFolder() : folder_(make_scratch_folder()) {}
ScratchFolder::~ScratchFolder() = default;

}  // namespace saccade
