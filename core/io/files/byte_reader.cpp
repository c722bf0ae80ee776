#include "core/io/files/byte_reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/check.h"
#include "core/error.h"

namespace saccade {
namespace {

constexpr std::size_t kReadAheadBytes = std::size_t{1} << 20;

}  // namespace

ByteReader::ByteReader(const std::filesystem::path& file) : name_(file.string()) {
  if (!std::filesystem::exists(file)) throw InputError(name_, "no such file");
  if (std::filesystem::is_directory(file)) throw InputError(name_, "is a folder, not a file");
  stream_.open(file, std::ios::binary);
  if (!stream_) throw InputError(name_, "cannot be opened");
  size_ = std::filesystem::file_size(file);
}

std::span<const std::byte> ByteReader::peek(std::size_t least) {
  if (end_ - begin_ < least && block_offset_ + end_ < size_) {
    std::copy(block_.begin() + static_cast<std::ptrdiff_t>(begin_),
              block_.begin() + static_cast<std::ptrdiff_t>(end_), block_.begin());
    block_offset_ += begin_;
    end_ -= begin_;
    begin_ = 0;
    const std::uint64_t rest = size_ - block_offset_;
    const auto wanted =
        static_cast<std::size_t>(std::min<std::uint64_t>(rest, std::max(least, kReadAheadBytes)));
    if (block_.size() < wanted) block_.resize(wanted);
    stream_.read(reinterpret_cast<char*>(block_.data() + end_),
                 static_cast<std::streamsize>(wanted - end_));
    if (!stream_) fail(block_offset_ + end_, "cannot be read on");
    end_ = wanted;
  }
  return {block_.data() + begin_, end_ - begin_};
}

std::span<const std::byte> ByteReader::take(std::uint64_t count, std::string_view what) {
  if (count > left())
    fail(offset(),
         fmt::format("the file ends within {}: {} bytes are missing", what, count - left()));
  const auto size = static_cast<std::size_t>(count);
  const std::span<const std::byte> bytes = peek(size).first(size);
  skip(size);
  return bytes;
}

void ByteReader::seek(std::uint64_t offset) {
  SACCADE_CHECK(offset <= size_);
  if (offset >= block_offset_ && offset <= block_offset_ + end_) {
    begin_ = static_cast<std::size_t>(offset - block_offset_);
    return;
  }
  stream_.seekg(static_cast<std::streamoff>(offset));
  block_offset_ = offset;
  begin_ = end_ = 0;
}

void ByteReader::fail(std::uint64_t offset, const std::string& problem) const {
  throw InputError(fmt::format("{}:byte {}", name_, offset), problem);
}

}  // namespace saccade
