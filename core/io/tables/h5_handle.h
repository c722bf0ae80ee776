#pragma once

#include <hdf5.h>

#include <mutex>
#include <string>
#include <utility>

namespace saccade {

/// Held during every call into HDF5, which is not thread-safe as Debian builds it; also keeps the
/// library from printing its error stack, because errors are reported with their location here.
class H5Lock {
 public:
  H5Lock();
  ~H5Lock();
  H5Lock(const H5Lock&) = delete;
  H5Lock& operator=(const H5Lock&) = delete;

 private:
  std::scoped_lock<std::recursive_mutex> lock_;
  H5E_auto2_t handler_ = nullptr;
  void* handler_data_ = nullptr;
};

/// Owns an HDF5 identifier; negative = none.
class H5Handle {
 public:
  using Closer = herr_t (*)(hid_t);

  H5Handle() = default;
  H5Handle(hid_t id, Closer closer) : id_(id), closer_(closer) {}
  H5Handle(H5Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), closer_(other.closer_) {}
  H5Handle& operator=(H5Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(closer_, other.closer_);
    return *this;
  }
  ~H5Handle() { close(); }

  /// False when the library failed to write what was pending.
  bool close() {
    if (id_ < 0) return true;
    const H5Lock lock;
    return closer_(std::exchange(id_, -1)) >= 0;
  }
  [[nodiscard]] bool valid() const { return id_ >= 0; }
  operator hid_t() const { return id_; }  // NOLINT: passed to HDF5 as it is

 private:
  hid_t id_ = -1;
  Closer closer_ = nullptr;
};

/// What HDF5 itself says about the last failure, or "" when it says nothing.
[[nodiscard]] std::string h5_reason();

}  // namespace saccade
