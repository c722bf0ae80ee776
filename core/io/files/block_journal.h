#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

namespace saccade {

/// An append-only file of blocks with checksums, for results that must outlive a program that is
/// killed: what flush() has handed to the system stays, whatever happens to the program (a machine
/// that loses power may lose some; the checksums tell). Appending is buffered. Errors of the disk
/// are InputErrors with the file's name.
class BlockJournal {
 public:
  /// Opens or creates `file`, and cuts it to its first `length` bytes, which an earlier length()
  /// stated. InputError when it is shorter.
  BlockJournal(const std::filesystem::path& file, std::uint64_t length);
  ~BlockJournal();  ///< what was not flushed is lost
  BlockJournal(const BlockJournal&) = delete;
  BlockJournal& operator=(const BlockJournal&) = delete;

  void append(std::span<const std::byte> bytes);
  void flush();
  /// Bytes of the file up to the last flush.
  [[nodiscard]] std::uint64_t length() const { return length_; }

  /// Calls `use` with everything that was appended before the last flush, block by block;
  /// InputError naming the byte offset when the file is damaged. A block holds whole appends, as
  /// many as fit.
  void read(const std::function<void(std::span<const std::byte>)>& use) const;

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
  std::uint64_t length_ = 0;
  std::vector<std::byte> block_;  ///< header and what is not written yet
};

/// The blocks of a journal that another program is filling, as they come. The file is not changed.
class BlockJournalTail {
 public:
  explicit BlockJournalTail(std::filesystem::path file);

  /// Calls `use` with the blocks that came since the last call, up to the first that is not
  /// complete. Nothing where the file is not there. One that was cut is read from its start again.
  void read(const std::function<void(std::span<const std::byte>)>& use);

 private:
  std::filesystem::path file_;
  std::uint64_t position_ = 0;
};

}  // namespace saccade
