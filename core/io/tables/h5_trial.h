#pragma once

#include <filesystem>

namespace saccade {

/// Reads in a process of its own what an HDF5 file says of its contents (groups, attributes, where the
/// parts of its datasets lie) and a part of each dataset. InputError where that process crashes or does
/// not come back, as HDF5 1.10 does on some damaged files; whatever HDF5 itself finds wrong is left to
/// the reader, which knows what it needs. Each version of a file is tried once by a
/// program. InputError as well where the system gives no process.
void try_h5_file(const std::filesystem::path& file);

}  // namespace saccade
