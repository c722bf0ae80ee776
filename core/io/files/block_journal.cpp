#include "core/io/files/block_journal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <zlib.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include "core/error.h"
#include "core/io/files/atomic_file.h"

namespace saccade {
namespace {

constexpr std::size_t kBlockBytes = std::size_t{1} << 16;

/// Before every block.
struct BlockHeader {
  std::uint32_t size = 0;  ///< of the block [bytes]
  std::uint32_t checksum = 0;
};

std::uint32_t checksum_of(std::span<const std::byte> bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
}

}  // namespace

BlockJournal::BlockJournal(const std::filesystem::path& file, std::uint64_t length)
    : file_(file), descriptor_(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0) fail_to_write(file_, errno);
  const off_t size = ::lseek(descriptor_, 0, SEEK_END);
  const bool too_short = size < 0 || static_cast<std::uint64_t>(size) < length;
  if (too_short || ::ftruncate(descriptor_, static_cast<off_t>(length)) != 0) {
    ::close(descriptor_);
    throw InputError(file_.string(), "is shorter than it was");
  }
  length_ = length;
  block_.resize(sizeof(BlockHeader));
}

BlockJournal::~BlockJournal() { ::close(descriptor_); }

void BlockJournal::append(std::span<const std::byte> bytes) {
  block_.insert(block_.end(), bytes.begin(), bytes.end());
  if (block_.size() >= kBlockBytes) flush();
}

void BlockJournal::flush() {
  const std::span<const std::byte> content = std::span(block_).subspan(sizeof(BlockHeader));
  if (content.empty()) return;
  const BlockHeader header{static_cast<std::uint32_t>(content.size()), checksum_of(content)};
  std::memcpy(block_.data(), &header, sizeof header);
  for (std::size_t done = 0; done < block_.size();) {
    const ssize_t n = ::pwrite(descriptor_, block_.data() + done, block_.size() - done,
                               static_cast<off_t>(length_ + done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) fail_to_write(file_, errno);
    done += static_cast<std::size_t>(n);
  }
  length_ += block_.size();
  block_.resize(sizeof(BlockHeader));
}

void BlockJournal::read(const std::function<void(std::span<const std::byte>)>& use) const {
  std::vector<std::byte> content;
  std::uint64_t position = 0;
  const auto fail = [&] {
    throw InputError(file_.string(), fmt::format("is damaged at byte {}", position));
  };
  const auto read_at = [&](std::uint64_t offset, std::span<std::byte> bytes) {
    while (!bytes.empty()) {
      const ssize_t n =
          ::pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) fail();
      bytes = bytes.subspan(static_cast<std::size_t>(n));
      offset += static_cast<std::uint64_t>(n);
    }
  };
  while (position < length_) {
    BlockHeader header;
    if (length_ - position < sizeof header) fail();
    read_at(position, std::as_writable_bytes(std::span(&header, 1)));
    if (header.size > length_ - position - sizeof header) fail();
    content.resize(header.size);
    read_at(position + sizeof header, content);
    if (checksum_of(content) != header.checksum) fail();
    use(content);
    position += sizeof header + header.size;
  }
}

BlockJournalTail::BlockJournalTail(std::filesystem::path file) : file_(std::move(file)) {}

void BlockJournalTail::read(const std::function<void(std::span<const std::byte>)>& use) {
  std::ifstream stream(file_, std::ios::binary | std::ios::ate);
  if (!stream) return;
  const auto size = static_cast<std::uint64_t>(stream.tellg());
  if (size < position_) position_ = 0;
  std::vector<std::byte> content;
  while (size - position_ > sizeof(BlockHeader)) {
    BlockHeader header;
    stream.seekg(static_cast<std::streamoff>(position_));
    stream.read(reinterpret_cast<char*>(&header), sizeof header);
    if (!stream || header.size > size - position_ - sizeof header) return;
    content.resize(header.size);
    stream.read(reinterpret_cast<char*>(content.data()), header.size);
    if (!stream || checksum_of(content) != header.checksum) return;
    position_ += sizeof header + header.size;
    use(content);
  }
}

}  // namespace saccade
