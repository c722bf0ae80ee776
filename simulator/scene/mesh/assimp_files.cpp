#include "simulator/scene/mesh/assimp_files.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace saccade {
namespace {

class MemoryStream : public Assimp::IOStream {
 public:
  explicit MemoryStream(Bytes bytes) : bytes_(std::move(bytes)) {}

  std::size_t Read(void* target, std::size_t size, std::size_t count) override {
    if (size == 0) return 0;
    const std::size_t items = std::min(count, (bytes_.size() - position_) / size);
    if (items > 0) std::memcpy(target, bytes_.data() + position_, items * size);
    position_ += items * size;
    return items;
  }

  std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }

  aiReturn Seek(std::size_t offset, aiOrigin origin) override {
    std::size_t from = 0;
    if (origin == aiOrigin_CUR) from = position_;
    if (origin == aiOrigin_END) from = bytes_.size();
    // Offsets backwards arrive as negative numbers turned into huge ones; the sum wraps back.
    if (from + offset > bytes_.size()) return aiReturn_FAILURE;
    position_ = from + offset;
    return aiReturn_SUCCESS;
  }

  std::size_t Tell() const override { return position_; }
  std::size_t FileSize() const override { return bytes_.size(); }
  void Flush() override {}

 private:
  Bytes bytes_;
  std::size_t position_ = 0;
};

}  // namespace

Assimp::IOStream* AssimpFiles::Open(const char* file, const char*) {
  const auto other = replaced_.find(file);
  if (other != replaced_.end()) return new MemoryStream(other->second);
  std::optional<Bytes> bytes = source_.read(file);
  (bytes ? opened_ : missing_).emplace_back(file);
  return bytes ? new MemoryStream(std::move(*bytes)) : nullptr;
}

}  // namespace saccade
