#include "core/io/tables/h5_handle.h"

namespace saccade {
namespace {

/// A file that could not be closed for lack of space stays behind half closed, and HDF5's clean-up at
/// the end of the program would crash on it. Everything else is closed by its handle; what is not would
/// not be flushed. A static variable, because HDF5 honours the call only before its first other one,
/// which may come from a test or from another library of the process.
[[maybe_unused]] const herr_t kNoCleanUp = H5dont_atexit();

std::recursive_mutex& h5_mutex() {
  static std::recursive_mutex mutex;
  return mutex;
}

}  // namespace

H5Lock::H5Lock() : lock_(h5_mutex()) {
  H5Eget_auto2(H5E_DEFAULT, &handler_, &handler_data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

H5Lock::~H5Lock() { H5Eset_auto2(H5E_DEFAULT, handler_, handler_data_); }

std::string h5_reason() {
  // No H5Lock: setting the error handler clears the error stack.
  const std::scoped_lock lock(h5_mutex());
  std::string reason;
  // The last entry on the way up is the deepest call, which knows most.
  const auto keep = [](unsigned, const H5E_error2_t* error, void* text) -> herr_t {
    if (error->desc != nullptr) *static_cast<std::string*>(text) = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, keep, &reason);
  return reason;
}

}  // namespace saccade
